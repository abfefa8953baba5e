// What a history costs beside one step of it, and a force beside torsion alone: times, work and the errors
// that they buy. A solution that is wrong is reported and not timed.

#include <fmt/core.h>

#include <algorithm>
#include <string>

#include "bench/suite/checked_solve.hpp"
#include "bench/suite/suite.hpp"
#include "bench/timing/side_by_side.hpp"

namespace slipstick::bench {
namespace {

using solver::Index;
using solver::ModelChoice;
using solver::Scene;
using solver::Solution;

/// model: what symmetry leaves out, or nothing.
Scene scene_of(Index cells, double moment_ratio, ModelChoice model) {
  Scene scene = paper_scene(cells, moment_ratio);
  scene.model = model;
  return scene;
}

void solve_all(const Scene& scene) { benchmark::DoNotOptimize(solver::solve(scene)); }

/// The benchmark's own time is the first scene's.
void time_against(Prepared& prepared, const Scene& first, const Scene& second) {
  show_ratio(prepared, side_by_side([&] { return seconds([&] { solve_all(first); }); },
                                    [&] { return seconds([&] { solve_all(second); }); }));
  prepared.timing = repeated([first] { solve_all(first); });
}

/// Reversals between 0.8 and -0.8 of the limit moment. The last one's errors.
Prepared torsion_cycles(Index cells, std::size_t reversals) {
  const Scene first_loading = scene_of(cells, 0.8, ModelChoice::automatic);
  Scene scene = first_loading;
  scene.steps.resize(reversals + 1, scene.steps.front());
  for (std::size_t i = 1; i < scene.steps.size(); i += 2) scene.steps[i].torsion = solver::MomentRatio{-0.8};
  const CheckedSolution checked = solve_and_check(scene);
  Prepared prepared{.counters = counters(checked), .invalid_reason = checked.invalid_reason};
  prepared.counters["dissipated_error"] = checked.errors.dissipated;
  if (prepared.invalid_reason.empty()) time_against(prepared, scene, first_loading);
  return prepared;
}

/// How far the certificate lets a load be off: rounding of sums over the contact.
constexpr double kAllowedLoadError = 1e-9;

/// A force leaves no symmetry to use; `torsion` says whether torsion alone uses it. No exact answer: the
/// certificate.
Prepared torsion_with_force(Index cells, ModelChoice torsion_model) {
  const Scene torsion = scene_of(cells, 0.5, torsion_model);
  Scene scene = torsion;
  auto& step = scene.steps.front();
  step.force = {0.3 * scene.friction * *step.normal, 0.0};
  const Solution solution = solver::solve(scene);
  const double load_error = std::max(solution.certificate.moment, solution.certificate.force);
  Prepared prepared{.counters = {{"gap", solution.certificate.gap},
                                 {"load_error", load_error},
                                 {"limit_factor", solution.limit.factor},
                                 {"applications", solution.operator_applications}},
                    .invalid_reason = solution.message};
  if (prepared.invalid_reason.empty() &&
      !(solution.certificate.gap <= scene.tolerance && load_error <= kAllowedLoadError)) {
    prepared.invalid_reason = "the certificate does not hold";
  }
  if (prepared.invalid_reason.empty()) time_against(prepared, scene, torsion);
  return prepared;
}

}  // namespace

void add_history_benchmarks(Suite& suite) {
  suite.add("paired/cycles_over_first_loading/cells:128/reversals:20",
            [] { return torsion_cycles(128, 20); });
  for (const Index cells : {256, 512}) {
    const auto name = [cells](const std::string& other) {
      return fmt::format("{}paired/with_force_over_{}/cells:{}", cells == 256 ? "" : "long/", other, cells);
    };
    suite.add(name("torsion"), [cells] { return torsion_with_force(cells, ModelChoice::automatic); });
    suite.add(name("full_torsion"), [cells] { return torsion_with_force(cells, ModelChoice::full); });
  }
}

}  // namespace slipstick::bench
