// What a history costs beside one step of it, and a force beside torsion alone: times, work and the errors
// that they buy. A solution that is wrong is reported and not timed.

#include <benchmark/benchmark.h>

#include <algorithm>

#include "bench/checked_solve.hpp"
#include "bench/side_by_side.hpp"

namespace {

using slipstick::bench::CheckedSolution;
using slipstick::bench::SideBySide;
using slipstick::solver::ModelChoice;
using slipstick::solver::Scene;
using slipstick::solver::Solution;

/// range(0): cells along a side; model: what symmetry leaves out, or nothing.
Scene scene_of(const benchmark::State& state, double moment_ratio, ModelChoice model) {
  Scene scene = slipstick::bench::paper_scene(state.range(0), moment_ratio);
  scene.model = model;
  return scene;
}

void solve_all(const Scene& scene) { benchmark::DoNotOptimize(slipstick::solver::solve(scene)); }

/// The benchmark's own time is the first scene's; `name` is first over second.
void time_against(benchmark::State& state, const Scene& first, const Scene& second, const char* name) {
  using slipstick::bench::seconds;
  const SideBySide times =
      slipstick::bench::side_by_side([&] { return seconds([&] { solve_all(first); }); },
                                     [&] { return seconds([&] { solve_all(second); }); });
  for ([[maybe_unused]] auto _ : state) state.SetIterationTime(times.first);
  state.counters[name] = times.ratio;
}

/// range(1): reversals between 0.8 and -0.8 of the limit moment. The last one's errors.
void torsion_cycles(benchmark::State& state) {
  const Scene first_loading = scene_of(state, 0.8, ModelChoice::automatic);
  Scene scene = first_loading;
  scene.steps.resize(static_cast<std::size_t>(state.range(1)) + 1, scene.steps.front());
  for (std::size_t i = 1; i < scene.steps.size(); i += 2) scene.steps[i].torsion.moment_ratio = -0.8;
  const CheckedSolution checked = slipstick::bench::solve_and_check(scene);
  if (!checked.objection.empty()) return state.SkipWithError(checked.objection.c_str());
  state.counters["twist_error"] = checked.errors.twist;
  state.counters["dissipated_error"] = checked.errors.dissipated;
  state.counters["gap"] = checked.solution.certificate.gap;
  state.counters["applications_of_last"] = checked.solution.operator_applications;
  time_against(state, scene, first_loading, "over_first_loading");
}

/// range(1): whether symmetry is left unused in torsion alone too, as the force leaves none. No exact answer:
/// the certificate.
void torsion_with_force(benchmark::State& state) {
  const Scene torsion =
      scene_of(state, 0.5, state.range(1) != 0 ? ModelChoice::full : ModelChoice::automatic);
  Scene scene = torsion;
  auto& step = scene.steps.front();
  step.force = {0.3 * scene.friction * *step.normal, 0.0};
  const Solution solution = slipstick::solver::solve(scene);
  if (solution.status != slipstick::solver::Status::converged) {
    return state.SkipWithError(solution.message.c_str());
  }
  state.counters["gap"] = solution.certificate.gap;
  state.counters["load_error"] = std::max(solution.certificate.moment, solution.certificate.force);
  state.counters["limit_factor"] = solution.limit.factor;
  state.counters["applications"] = solution.operator_applications;
  time_against(state, scene, torsion, "over_torsion");
}

/// The rounds are within one iteration.
void once(benchmark::internal::Benchmark* benchmark) {
  benchmark->UseManualTime()->Iterations(1)->Unit(benchmark::kMillisecond);
}

BENCHMARK(torsion_cycles)->Apply(once)->ArgNames({"cells", "reversals"})->ArgsProduct({{128}, {20}});
BENCHMARK(torsion_with_force)->Apply(once)->ArgNames({"cells", "full"})->ArgsProduct({{256, 512}, {0, 1}});

}  // namespace
