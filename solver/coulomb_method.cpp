#include "solver/coulomb_method.hpp"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <utility>

#include "solver/certificate.hpp"
#include "solver/nested_iteration.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// Torsion's q1 is even in x1 and odd in x2, q2 the reverse.
constexpr std::array<Parity, 2> kTorsionParities{{{1, -1}, {-1, 1}}};

/// The torsional problem on one grid, as solve_nested() asks for it.
class TorsionOnGrid {
 public:
  TorsionOnGrid(const Grid& grid, TorsionProblem problem)
      : problem_(std::move(problem)),
        rotation_(contact_rotation(grid, problem_.friction_bound)),
        limit_(moment_limit(grid, problem_.friction_bound)) {}

  static BlockKernel kernel() { return tangential_kernel(); }
  static std::span<const Parity> parities() { return kTorsionParities; }
  FrictionDiscs admissible() const { return FrictionDiscs(problem_.friction_bound); }
  ConvexProgram program() const {
    return {.g = problem_.initial_displacement.size() > 0 ? &problem_.initial_displacement : nullptr,
            .c = rotation_,
            .load = problem_.moment,
            .multiplier = problem_.twist};
  }

  /// The same part of the limit moment on the coarse grid.
  TorsionOnGrid coarsened(const Grid& grid, const Grid& coarse) const {
    TorsionProblem problem;
    problem.friction_bound = restrict_to(coarse, grid, problem_.friction_bound);
    if (problem_.initial_displacement.size() > 0) {
      problem.initial_displacement = restrict_to(coarse, grid, problem_.initial_displacement);
    }
    problem.twist = problem_.twist;
    if (problem_.moment) {
      const double ratio = limit_ > 0.0 ? *problem_.moment / limit_ : 0.0;
      problem.moment = ratio * moment_limit(coarse, problem.friction_bound);
    }
    return {coarse, problem};
  }

  const TorsionProblem& problem() const { return problem_; }
  const ArrayXd& rotation() const { return rotation_; }

 private:
  /// (-x2, x1) in the contact, zero outside.
  static ArrayXd contact_rotation(const Grid& grid, const ArrayXd& friction_bound) {
    return (friction_bound > 0.0).cast<double>().replicate(2, 1) * rotation_field(grid);
  }

  TorsionProblem problem_;
  ArrayXd rotation_;
  double limit_;
};

/// Slip where the bodies touch, and the stick area: where the tractions stay within their bound.
void describe(TorsionSolution& solution, const TorsionOnGrid& torsion) {
  const ArrayXd& bound = torsion.problem().friction_bound;
  const ArrayXd contact = (bound > 0.0).cast<double>();
  ArrayXd slip = solution.elastic_displacement - solution.twist * torsion.rotation();
  if (torsion.problem().initial_displacement.size() > 0) slip += torsion.problem().initial_displacement;
  solution.slip = contact.replicate(2, 1) * slip;
  // Slipping cells lie on their circle up to rounding; within it a cell sticks.
  constexpr double kOnCircle = 1e-12;
  solution.stick = contact * (norms(solution.traction) < (1.0 - kOnCircle) * bound).cast<double>();
}

TorsionSolution unloaded(const Grid& grid) {
  TorsionSolution solution;
  solution.status = Status::converged;
  solution.traction.setZero(2 * grid.cells());
  solution.elastic_displacement = solution.slip = solution.traction;
  solution.stick.setZero(grid.cells());
  return solution;
}

}  // namespace

double predicted_coulomb_bytes(const Elasticity& elasticity, const Grid& grid) {
  return predicted_nested_bytes<FrictionDiscs>(elasticity, grid, tangential_kernel());
}

TorsionSolution solve_by_coulomb_method(const Elasticity& elasticity, const Grid& grid,
                                        const TorsionProblem& problem, const CoulombOptions& options) {
  require_valid(problem, grid);
  if ((problem.friction_bound == 0.0).all()) return unloaded(grid);
  const TorsionOnGrid torsion(grid, problem);
  NewtonOptions newton{.tolerance = options.tolerance, .max_applications = options.max_applications};
  if (options.progress) {
    newton.progress = [&](long applications, double gap) {
      options.progress(static_cast<int>(applications), gap);
    };
  }
  NestedSummary nested = solve_nested(elasticity, grid, torsion, newton);
  TorsionSolution solution;
  solution.status = nested.newton.converged ? Status::converged : Status::not_converged;
  if (!nested.newton.converged) {
    solution.message = fmt::format("{}: gap / energy {:.3g}, asked for {:.3g}", nested.newton.message,
                                   nested.newton.gap, options.tolerance);
  }
  solution.traction = std::move(nested.field);
  solution.elastic_displacement = std::move(nested.displacement);
  solution.twist = nested.newton.multiplier;
  solution.tangent_stiffness = nested.newton.tangent_stiffness;
  solution.change = nested.newton.gap;
  solution.iterations = nested.newton.iterations;
  solution.grids = std::move(nested.grids);
  solution.bytes = nested.bytes;
  describe(solution, torsion);
  return solution;
}

}  // namespace slipstick::solver
