// The pressure of the paper's sphere, with its errors against Hertz's solution.

#include <memory>

#include "bench/suite/paper_scene.hpp"
#include "bench/suite/suite.hpp"
#include "convergence/results/exact_result.hpp"
#include "solver/model/make_model.hpp"
#include "solver/model/memory_plan.hpp"
#include "solver/step/describe_step.hpp"
#include "solver/step/pressure.hpp"

namespace slipstick::bench {
namespace {

using solver::Index;
using solver::Scene;

/// The error of the pressure in L2 is of first order in the cells, by the contact's edge; twice as large as
/// measured on 32 to 1,024 cells.
constexpr double kPressureErrorTimesCells = 0.8;

Prepared solve(Index cells) {
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

}  // namespace

void add_normal_benchmarks(Suite& suite) { suite.add_sizes("normal/solve", {32, 64, 128, 256, 512, 1024}, solve); }

}  // namespace slipstick::bench
