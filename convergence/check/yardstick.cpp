#include "convergence/check/yardstick.hpp"

#include <stdexcept>

#include "convergence/check/fitted_motion.hpp"
#include "solver/coulomb_method.hpp"
#include "solver/grid_transfer.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using solver::Grid;
using solver::Index;

/// Twice as many cells along each axis, of half the size.
Grid finer(const Grid& grid) { return {2 * grid.n1, 2 * grid.n2, 0.5 * grid.h1, 0.5 * grid.h2}; }

/// Each fine cell has its parent's value.
ArrayXd handed_down(const Grid& grid, const ArrayXd& values) {
  const Grid fine = finer(grid);
  ArrayXd down(fine.cells());
  for (Index i = 0; i < fine.n1; ++i) {
    for (Index j = 0; j < fine.n2; ++j) down[i * fine.n2 + j] = values[(i / 2) * grid.n2 + j / 2];
  }
  return down;
}

/// The same problem on the finer mesh; loads are over the cell area.
solver::TangentialProblem refined(const GivenContact& contact, const solver::TangentialProblem& problem) {
  constexpr double kChildren = 4.0;
  const Grid& grid = contact.model.grid;
  const auto& [f1, f2] = *problem.force;
  return {.friction_bound = handed_down(grid, problem.friction_bound),
          .initial_displacement = pressure_displacement(contact.model, contact.elasticity, finer(grid),
                                                        handed_down(grid, contact.pressure)),
          .moment = kChildren * *problem.moment,
          .twist = {},
          .force = std::array{kChildren * f1, kChildren * f2}};
}

void measure_mesh(Yardstick& yardstick, const GivenContact& contact, const ArrayXd& averaged) {
  GivenContact mean = contact;
  mean.traction = averaged;
  contact.elasticity.make(contact.model.grid, solver::tangential_kernel())
      ->apply(averaged, mean.elastic_displacement);
  mean.displacement += mean.elastic_displacement - contact.elastic_displacement;
  const FittedMotion fitted = fit_motion(mean.displacement, averaged, mean.friction_bound,
                                         rigid_motions(mean, {}, std::nullopt).free);
  yardstick.gap = fitted.gap.sum() / mean.energy();
  yardstick.direction = solver::slip_direction(averaged, fitted.slip);
  yardstick.mesh_error = relative_distance(averaged, yardstick.traction);
}

solver::TangentialSolution solved(const GivenContact& contact, const Grid& grid,
                                  const solver::TangentialProblem& problem) {
  solver::TangentialSolution solution = solve_by_coulomb_method(contact.elasticity, grid, problem);
  if (solution.status != solver::Status::converged) {
    throw std::runtime_error("the right answer to judge by was not found: " + solution.message);
  }
  return solution;
}

}  // namespace

double relative_distance(const ArrayXd& traction, const ArrayXd& reference) {
  return solver::norms(traction - reference).sum() / solver::norms(reference).sum();
}

Yardstick find_yardstick(const GivenContact& contact) {
  Yardstick yardstick;
  const Grid& grid = contact.model.grid;
  solver::TangentialProblem problem = own_problem(contact);
  if (const double factor = solver::limit_of(problem, grid).factor; !(factor > 1.0)) {
    yardstick.scaled = true;
    *problem.moment *= kScaledLoads * factor;
    for (double& force : *problem.force) force *= kScaledLoads * factor;
  }
  const solver::TangentialSolution right = solved(contact, grid, problem);
  const solver::TangentialSolution fine = solved(contact, finer(grid), refined(contact, problem));
  yardstick.traction = right.traction;
  yardstick.twist = right.twist;
  yardstick.displacement = {right.displacement[0] + right.twist * contact.centre[1],
                            right.displacement[1] - right.twist * contact.centre[0]};
  measure_mesh(yardstick, contact, solver::restrict_to(grid, finer(grid), fine.traction));
  return yardstick;
}

}  // namespace slipstick::convergence
