#include "solver/solve.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <utility>

#include "solver/input_error.hpp"
#include "solver/mirror.hpp"
#include "solver/paper_method.hpp"
#include "solver/pressure.hpp"
#include "solver/projected_gradient.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

class Stopwatch {
 public:
  /// Seconds since the last call, or since construction.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(start_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The pressure's tangential displacement, Eq. (12).
ArrayXd pressure_displacement(const Scene& scene, const Model& model, const ArrayXd& pressure) {
  if (!model.pressure_coupling) return {};
  const auto op = elasticity(scene, model, Reduction(model.grid)).make(model.grid, coupling_kernel());
  ArrayXd u(2 * pressure.size());
  op->apply(pressure, u);
  return u;
}

/// The load on the tangential problem in the model's units; refuses gross slip.
TorsionProblem torsion_problem(const Scene& scene, const Model& model, const ArrayXd& pressure) {
  TorsionProblem problem;
  problem.friction_bound = model.friction * pressure;
  problem.initial_displacement = pressure_displacement(scene, model, pressure);
  const double limit = moment_limit(model.grid, problem.friction_bound);
  if (scene.torsion.twist) {
    problem.twist = scene.torsion.twist;
  } else if (scene.torsion.moment_ratio) {
    problem.moment = *scene.torsion.moment_ratio * limit;
  } else {
    problem.moment = over_unit(*scene.torsion.moment, model.moment_unit()) / model.grid.cell_area();
  }
  if (problem.moment && *problem.moment > 0.0 && !(*problem.moment < limit)) {
    throw InputError(
        scene.source.string(), "load.moment", fmt::format("{} N m", *scene.torsion.moment),
        fmt::format("below {:.17g} N m, the limit moment of this pressure and mesh; at or above it the "
                    "contact slips everywhere",
                    limit * model.grid.cell_area() * model.moment_unit()));
  }
  return problem;
}

double equal_area_radius(const Grid& grid, Index cells) {
  return std::sqrt(static_cast<double>(cells) * grid.cell_area() / std::numbers::pi);
}

void describe(Solution& solution, const TorsionProblem& problem) {
  const Model& model = solution.model;
  const Grid& grid = model.grid;
  const ArrayXd& pressure = solution.normal.pressure;
  solution.normal_load = pressure.sum() * grid.cell_area() * model.force_unit();
  solution.peak_pressure = pressure.maxCoeff() * model.stress_unit;
  solution.approach = solution.normal.approach * model.length_unit;
  solution.contact_cells = (pressure > 0.0).count();
  solution.stick_cells = (solution.torsion.stick > 0.0).count();
  solution.contact_radius = measure_contact_radius(model, pressure) * model.length_unit;
  solution.contact_radius_counted = equal_area_radius(grid, solution.contact_cells) * model.length_unit;
  solution.stick_radius_counted = equal_area_radius(grid, solution.stick_cells) * model.length_unit;
  const StickFront front =
      find_stick_front(grid, problem.friction_bound, solution.torsion.slip, solution.torsion.stick);
  solution.stick_radius = front.radius * model.length_unit;
  solution.stick_radius_note = front.why_counted;
  solution.twist_angle = solution.torsion.twist;
  const double moment_unit = grid.cell_area() * model.moment_unit();
  const ArrayXd rotation = rotation_field(grid);
  const double moment = (solution.torsion.traction * rotation).sum();
  solution.moment = moment * moment_unit;
  solution.moment_limit = moment_limit(grid, problem.friction_bound) * moment_unit;
  solution.certificate =
      certify({solution.torsion.traction, solution.torsion.elastic_displacement, solution.torsion.slip},
              problem.friction_bound, rotation, problem.moment.value_or(moment));
  solution.slip_direction = slip_direction(solution.torsion.traction, solution.torsion.slip);
}

/// The problem on a part of the grid. A quadrant carries a quarter of the moment.
TorsionProblem reduced(const TorsionProblem& problem, const Reduction& part) {
  const double images = part.quadrant() ? 4.0 : 1.0;
  TorsionProblem on_part{.friction_bound = part.restricted(problem.friction_bound),
                         .initial_displacement = part.restricted(problem.initial_displacement),
                         .moment = problem.moment,
                         .twist = problem.twist};
  if (on_part.moment) *on_part.moment /= images;
  return on_part;
}

void expand(TorsionSolution& solution, const Reduction& part) {
  for (ArrayXd* const field : {&solution.traction, &solution.elastic_displacement, &solution.slip}) {
    *field = part.expanded(*field, torsion_symmetry());
  }
  solution.stick = part.expanded(solution.stick, normal_symmetry());
  if (part.quadrant()) solution.tangent_stiffness *= 4.0;
}

TorsionSolution solve_on(const Scene& scene, const Model& model, const Reduction& part,
                         const TorsionProblem& problem, const SolveOptions& options) {
  const Elasticity elastic = elasticity(scene, model, part);
  if (scene.method == Method::coulomb) {
    return solve_by_coulomb_method(elastic, part.grid(), problem,
                                   {.tolerance = scene.tolerance,
                                    .max_applications = scene.max_iterations,
                                    .progress = options.progress});
  }
  const auto op = elastic.make(part.grid(), tangential_kernel());
  TorsionSolution solution = scene.method == Method::paper
                                 ? solve_by_paper_method(*op, problem,
                                                         {.tolerance = scene.tolerance,
                                                          .max_iterations = scene.max_iterations,
                                                          .progress = options.progress})
                                 : solve_by_projected_gradient(*op, problem,
                                                               {.tolerance = scene.tolerance,
                                                                .max_iterations = scene.max_iterations,
                                                                .start = {},
                                                                .progress = options.progress});
  solution.grids = {
      {part.grid().n1, part.grid().n2, op->applications(), solution.iterations, solution.change}};
  solution.bytes = static_cast<double>(op->bytes());
  return solution;
}

}  // namespace

double measure_contact_radius(const Model& model, const ArrayXd& pressure) {
  const auto semi_axis = [&](const ArrayXd& x) {
    return std::sqrt(5.0 * (pressure * x.square()).sum() / pressure.sum());
  };
  const double radius = std::sqrt(semi_axis(cell_x1(model.grid)) * semi_axis(cell_x2(model.grid)));
  // A contact one cell wide has no second moment.
  return model.hertz && radius > 0.0 ? radius : equal_area_radius(model.grid, (pressure > 0.0).count());
}

Solution solve(const Scene& scene, const SolveOptions& options) {
  if (scene.model == ModelChoice::exact) {
    throw InputError(scene.source.string(), "solver.model", "\"exact\"", "auto, full for a solve on a grid");
  }
  Stopwatch watch;
  Solution solution;
  solution.model = make_model(scene);
  const Model& model = solution.model;
  solution.seconds.setup = watch.lap();

  solution.normal = find_pressure(scene, model);
  solution.seconds.pressure = watch.lap();

  const TorsionProblem problem = torsion_problem(scene, model, solution.normal.pressure);
  const Reduction part = traction_part(scene, solution.model, solution.normal.pressure);
  const TorsionProblem on_part = reduced(problem, part);
  solution.seconds.setup += watch.lap();

  solution.torsion = solve_on(scene, model, part, on_part, options);
  expand(solution.torsion, part);
  solution.seconds.traction = watch.lap();

  solution.operator_applications = finest_grid_applications(solution.torsion.grids);
  solution.pressure_applications = finest_grid_applications(solution.normal.grids);
  solution.bytes = std::max(solution.normal.bytes, solution.torsion.bytes);
  const bool converged =
      solution.normal.status == Status::converged && solution.torsion.status == Status::converged;
  solution.status = converged ? Status::converged : Status::not_converged;
  if (!solution.normal.message.empty()) solution.message = "pressure: " + solution.normal.message;
  if (!solution.torsion.message.empty()) {
    solution.message += (solution.message.empty() ? "traction: " : "; traction: ") + solution.torsion.message;
  }
  describe(solution, problem);
  solution.seconds.total =
      solution.seconds.setup + solution.seconds.pressure + solution.seconds.traction + watch.lap();
  return solution;
}

}  // namespace slipstick::solver
