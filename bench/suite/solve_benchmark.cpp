// The pressure of the paper's sphere, and whole solves of its scene, with their errors: by each method, to several
// tolerances, on the whole grid, along a history, and with a force in addition to the torsion. Two of them are
// compared in interleaved pairs by `slipstick bench --pair A B`.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "bench/suite/suite.hpp"
#include "bench/timing/checked_solve.hpp"
#include "convergence/results/exact_result.hpp"
#include "convergence/runs/path_uncertainty.hpp"
#include "solver/model/make_model.hpp"
#include "solver/model/memory_plan.hpp"
#include "solver/step/describe_step.hpp"
#include "solver/step/pressure.hpp"

namespace slipstick::bench {
namespace {

using solver::Index;
using solver::Method;
using solver::Scene;

/// The paper's scene on cells x cells cells under a part of the limit moment: Coulomb's method, nothing left
/// out of the model, solved pressure, one thread, tolerance 1e-8.
Scene paper_scene(Index cells, double moment_ratio) {
  Scene scene = solver::read_scene(std::filesystem::path(SLIPSTICK_SCENES) / "paper.toml");
  scene.grid.cells = {cells, cells};
  scene.steps[0].torsion = solver::MomentRatio{moment_ratio};
  scene.solver.method = solver::Method::coulomb;
  scene.solver.model = solver::ModelChoice::full;
  scene.contact.pressure = solver::PressureModel::solved;
  scene.solver.tolerance = 1e-8;
  scene.solver.threads = 1;
  return scene;
}

/// Errors, certificate, work and memory.
std::map<std::string, benchmark::Counter> counters(const CheckedSolution& checked) {
  const auto& [solution, errors, invalid_reason] = checked;
  const std::map<std::string, double> values{{"twist_error", errors.twist},
                                             {"traction_error", errors.traction.at_centres.l2},
                                             {"stick_radius_error", errors.stick_radius},
                                             {"gap", solution.certificate.gap},
                                             {"applications", solution.operator_applications},
                                             {"pressure_applications", solution.pressure_applications},
                                             {"iterations", solution.iterations},
                                             {"bytes", solution.bytes}};
  std::map<std::string, benchmark::Counter> result;
  for (const auto& [name, value] : values) {
    if (std::isfinite(value)) result[name] = value;  // JSON has no NaN
  }
  return result;
}

/// The error of the pressure in L2 is of first order in the cells, by the contact's edge; twice as large as
/// measured on 32 to 1,024 cells.
constexpr double kPressureErrorTimesCells = 0.8;

Prepared pressure(Index cells) {
  Scene scene = paper_scene(cells, 0.5);
  scene.solver.model = solver::ModelChoice::automatic;
  const convergence::Oracle exact = convergence::require_oracle(scene);
  const auto model = std::make_shared<solver::Model>(solver::make_model(scene));
  const auto find = [scene, model] { return solver::find_pressure(scene, *model, scene.steps[0]); };
  const solver::NormalSolution found = find();
  const double error = convergence::pressure_error(model->stress_unit * found.pressure, exact, model->grid_in_m()).l2;
  const double radius = solver::measure_contact_radius(*model, found.pressure);
  const bool right = error <= kPressureErrorTimesCells / static_cast<double>(cells);
  return {.counters = {{"error", error},
                       {"contact_radius_error", radius / model->hertz->semi_axis_1 - 1.0},
                       {"complementarity", found.complementarity},
                       {"applications", solver::finest_grid_applications(found.grids)},
                       {"iterations", found.iterations},
                       {"bytes", solver::predicted_memory(scene, *model).solver}},
          .invalid_reason = found.status != solver::Status::converged ? found.message
                            : right                                   ? ""
                                                                      : "the pressure is not Hertz's",
          .timing = repeated([find] { benchmark::DoNotOptimize(find()); })};
}

/// Cells along a side, and the moment in thousandths of its limit.
struct Load {
  Index cells;
  int permille;

  Scene scene() const { return paper_scene(cells, 1e-3 * permille); }
  std::string name() const { return fmt::format("/cells:{}/permille:{}", cells, permille); }
};

Scene with_symmetry(Scene scene) {
  scene.solver.model = solver::ModelChoice::automatic;
  return scene;
}

Scene with_method(Scene scene, Method method, double tolerance) {
  scene.solver.method = method;
  scene.solver.tolerance = tolerance;
  return scene;
}

/// The scene's load, and then reversals between it and its negative.
Scene with_reversals(Scene scene, std::size_t reversals) {
  const double moment_ratio = *solver::value_if<solver::MomentRatio>(scene.steps.front().torsion);
  scene.steps.resize(reversals + 1, scene.steps.front());
  for (std::size_t i = 1; i < scene.steps.size(); i += 2) scene.steps[i].torsion = solver::MomentRatio{-moment_ratio};
  return scene;
}

Prepared whole_solve(const Scene& scene) {
  const CheckedSolution checked = solve_and_check(scene);
  return {.counters = counters(checked),
          .invalid_reason = checked.invalid_reason,
          .timing = repeated([scene] { benchmark::DoNotOptimize(convergence::solve_with_path(scene)); })};
}

/// With a force there is no symmetry and no exact answer, so the certificate bounds the error.
Prepared with_force(const Load& load) {
  constexpr double kAllowedLoadError = 1e-9;  // relative: rounding of sums over the contact
  Scene scene = load.scene();
  auto& step = scene.steps.front();
  step.force = {0.3 * scene.contact.friction.coefficient * *step.normal, 0.0};
  const solver::Solution solution = convergence::solve_with_path(scene);
  const double load_error = std::max(solution.certificate.moment, solution.certificate.force);
  const bool holds = solution.certificate.gap <= scene.solver.tolerance && load_error <= kAllowedLoadError;
  return {.counters = {{"gap", solution.certificate.gap},
                       {"load_error", load_error},
                       {"limit_factor", solution.limit.factor},
                       {"applications", solution.operator_applications}},
          .invalid_reason = !solution.message.empty() ? solution.message
                            : holds                   ? ""
                                                      : "the certificate does not hold",
          .timing = repeated([scene] { benchmark::DoNotOptimize(convergence::solve_with_path(scene)); })};
}

/// Each method to the tolerance that scenes commonly ask of it: a gap, or the change of Eq. (26).
void add_methods(Suite& suite, const Load& load) {
  constexpr double kPaperTolerance = 1e-5;
  const auto add = [&](const std::string& method, const Scene& scene) {
    suite.add("solve/" + method + load.name(), [scene] { return whole_solve(scene); });
  };
  const Scene scene = with_symmetry(load.scene());
  add("coulomb", scene);
  if (load.permille == 900 && load.cells < 1024) add("coulomb_full", load.scene());
  if (load.permille == 990 || load.cells > 256) return;
  add("paper", with_method(scene, Method::paper, kPaperTolerance));
}

}  // namespace

void add_solve_benchmarks(Suite& suite) {
  suite.add_sizes("normal/solve", {32, 64, 128, 256, 512, 1024}, pressure);
  for (const Index cells : {64, 128, 256, 512, 1024}) {
    for (const int permille : {500, 900, 990}) add_methods(suite, {cells, permille});
  }
  for (const int digits : {4, 6, 10, 12}) {
    const Load load{256, 900};
    suite.add(fmt::format("solve/coulomb{}/digits:{}", load.name(), digits), [=] {
      return whole_solve(with_method(with_symmetry(load.scene()), Method::coulomb, std::pow(10.0, -digits)));
    });
  }
  for (const std::size_t reversals : {0U, 20U}) {
    const Load load{128, 800};
    suite.add(fmt::format("solve/coulomb{}/reversals:{}", load.name(), reversals),
              [=] { return whole_solve(with_reversals(with_symmetry(load.scene()), reversals)); });
  }
  for (const Index cells : {256, 512}) {
    const Load load{cells, 500};
    suite.add((cells == 256 ? "" : "long/") + ("solve/with_force" + load.name()), [load] { return with_force(load); });
  }
}

}  // namespace slipstick::bench
