#include "solver/contact/full_coupling.hpp"

#include <fmt/core.h>

#include <limits>
#include <utility>

#include "solver/newton/admissible.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

constexpr int kMaxTurns = 100;
/// The gap has to fall by this part of the step in a turn, or the next ones are more careful.
constexpr double kProgress = 0.1;
constexpr double kMinStep = 1.0 / 64.0;

/// Complementarity gap of a pressure under an opening besides its own, over p.Kp/2.
class Complementarity {
 public:
  Complementarity(const Elasticity& elasticity, const Grid& grid, const ArrayXd& gap)
      : op_(elasticity.make(grid, normal_kernel())),
        reachable_(gap.isFinite().cast<double>()),
        height_((reachable_ > 0.0).select(gap, 0.0)),
        u_(grid.cells()) {}

  double operator()(const ArrayXd& pressure, const ArrayXd& opening) {
    op_->apply(pressure, u_);
    const double energy = 0.5 * (pressure * u_).sum();
    return PositivePressures(reachable_).gap(pressure, u_ + height_ + opening) / energy;
  }

 private:
  std::unique_ptr<LinearOperator> op_;
  ArrayXd reachable_, height_, u_;
};

bool converged(const CoupledSolution& solution) {
  return solution.normal.status == Status::converged && solution.tangential.status == Status::converged;
}

}  // namespace

ShearOpening::ShearOpening(const Elasticity& elasticity, const Grid& grid)
    : op_(elasticity.make(grid, shear_kernel())) {}

ArrayXd ShearOpening::operator()(const ArrayXd& traction) {
  ArrayXd u(op_->grid().cells());
  op_->apply(traction, u);
  return -u;
}

CoupledSolution solve_fully_coupled(const Elasticity& elasticity, const Grid& grid,
                                    const CoupledProblem& problem) {
  ShearOpening opening_by(elasticity, grid);
  Complementarity complementarity(elasticity, grid, problem.gap);
  ArrayXd opening = opening_by(problem.traction);
  double gap = std::numeric_limits<double>::infinity();
  double step = 1.0;
  CoupledSolution solution;
  for (solution.turns = 1; solution.turns <= kMaxTurns; ++solution.turns) {
    solution.normal = problem.solve_pressure(opening);
    solution.tangential = problem.solve_tractions(solution.normal.pressure);
    if (!converged(solution)) return solution;
    const ArrayXd change = opening_by(solution.tangential.traction) - opening;
    const double last = std::exchange(gap, complementarity(solution.normal.pressure, opening + change));
    solution.normal.complementarity = gap;
    if (gap <= problem.tolerance) return solution;
    if (!(gap <= (1.0 - kProgress * step) * last)) step *= 0.5;
    if (!(step >= kMinStep)) break;
    opening += step * change;
  }
  solution.normal.status = Status::not_converged;
  solution.normal.message = fmt::format(
      "pressure and shear drive each other apart: complementarity gap {:.3g} after {} turns, asked for "
      "{:.3g}; "
      "contact.coupling = \"pressure\" leaves the shear's effect on the pressure out",
      gap, solution.turns, problem.tolerance);
  return solution;
}

}  // namespace slipstick::solver
