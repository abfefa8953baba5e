#include "solver/contact/coulomb_method.hpp"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "solver/contact/certificate.hpp"
#include "solver/newton/nested_iteration.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// Torsion's q1 is even in x1 and odd in x2, q2 the reverse.
constexpr std::array<Parity, 2> kTorsionParities{{{1, -1}, {-1, 1}}};

/// The tangential problem on one grid, as solve_nested() asks for it.
class TangentialOnGrid {
 public:
  TangentialOnGrid(const Grid& grid, TangentialProblem problem)
      : problem_(std::move(problem)),
        contact_((problem_.friction_bound > 0.0).cast<double>()),
        rotation_(contact_.replicate(2, 1) * rotation_field(grid)) {
    if (problem_.start.size() == 0) problem_.start.setZero(rotation_.size());
    if (!problem_.force && !problem_.displacement) return;
    for (std::size_t component = 0; component < 2; ++component) {
      translation_[component].setZero(rotation_.size());
      translation_[component].segment(static_cast<Index>(component) * contact_.size(), contact_.size()) =
          contact_;
    }
  }

  static BlockKernel kernel() { return tangential_kernel(); }
  static std::span<const Parity> parities() { return kTorsionParities; }
  FrictionDiscs admissible() const { return FrictionDiscs(problem_.friction_bound); }
  ArrayXd start() const { return problem_.start; }

  /// Translations first, where they are modelled.
  ConvexProgram program(LinearOperator& op) {
    reference_ = problem_.initial_displacement;
    if ((problem_.start != 0.0).any()) {
      ArrayXd before(problem_.start.size());
      op.apply(problem_.start, before);
      reference_ = reference_.size() > 0 ? ArrayXd(reference_ - before) : ArrayXd(-before);
    }
    ConvexProgram program;
    if (reference_.size() > 0) program.g = &reference_;
    for (std::size_t component = 0; component < 2; ++component) {
      if (problem_.force) program.imposed.push_back({&translation_[component], (*problem_.force)[component]});
      if (problem_.displacement) {
        program.given.push_back({&translation_[component], (*problem_.displacement)[component]});
      }
    }
    if (problem_.moment) program.imposed.push_back({&rotation_, *problem_.moment});
    if (problem_.twist) program.given.push_back({&rotation_, *problem_.twist});
    return program;
  }

  /// The same part of the limit loads on the coarse grid.
  TangentialOnGrid coarsened(const Grid& grid, const Grid& coarse) const {
    TangentialProblem problem = problem_;
    problem.friction_bound = restrict_to(coarse, grid, problem_.friction_bound);
    problem.start = restrict_to(coarse, grid, problem_.start);
    if (problem_.initial_displacement.size() > 0) {
      problem.initial_displacement = restrict_to(coarse, grid, problem_.initial_displacement);
    }
    const double scaled = limit_of(problem, coarse).factor / limit_of(problem_, grid).factor;
    const double scale = std::isfinite(scaled) ? scaled : 1.0;  // no load: nothing to scale
    if (problem.moment) *problem.moment *= scale;
    if (problem.force) *problem.force = {scale * (*problem.force)[0], scale * (*problem.force)[1]};
    return {coarse, problem};
  }

 private:
  TangentialProblem problem_;
  ArrayXd contact_;   ///< 1 where tractions may be
  ArrayXd rotation_;  ///< (-x2, x1) there
  std::array<ArrayXd, 2> translation_;
  ArrayXd reference_;
};

/// The motions: those that the program found, and those that it was given.
void describe_motion(TangentialSolution& solution, const NewtonSummary& newton,
                     const TangentialProblem& problem) {
  const Coefficients& found = newton.multipliers;
  if (problem.displacement) solution.displacement = *problem.displacement;
  if (problem.force && found.size() >= 2) solution.displacement = {found[0], found[1]};
  solution.twist = problem.twist      ? *problem.twist
                   : found.size() > 0 ? found[found.size() - 1]
                                      : std::numeric_limits<double>::quiet_NaN();
}

/// dM/dphi. Where forces are imposed, the translations answer.
double turning_stiffness(const CoefficientMatrix& stiffness, const TangentialProblem& problem) {
  const Eigen::Index n = stiffness.rows();
  if (n == 0) return 0.0;
  // Imposed loads come before given motions: the rotation is last, unless it alone is imposed.
  const Eigen::Index turn = problem.moment && problem.displacement ? 0 : n - 1;
  if (!problem.force) return stiffness(turn, turn);
  const Eigen::Vector2d coupled = stiffness.block<2, 1>(0, turn);
  const Eigen::Matrix2d pushed = stiffness.topLeftCorner<2, 2>();
  return stiffness(turn, turn) - coupled.dot(pushed.ldlt().solve(coupled));
}

/// Slip where the bodies touch, and the stick area: where the tractions stay within their bound.
void describe(TangentialSolution& solution, const TangentialProblem& problem, const NestedSummary& nested) {
  const ArrayXd& bound = problem.friction_bound;
  const ArrayXd contact = (bound > 0.0).cast<double>();
  solution.slip = contact.replicate(2, 1) * nested.slip;
  // Slipping cells lie on their circle up to rounding; within it a cell sticks.
  constexpr double kOnCircle = 1e-12;
  solution.stick = contact * (norms(solution.traction) < (1.0 - kOnCircle) * bound).cast<double>();
}

TangentialSolution unloaded(const Grid& grid) {
  TangentialSolution solution;
  solution.status = Status::converged;
  solution.traction.setZero(2 * grid.cells());
  solution.elastic_displacement = solution.slip = solution.traction;
  solution.stick.setZero(grid.cells());
  return solution;
}

}  // namespace

double predicted_coulomb_bytes(const Elasticity& elasticity, const Grid& grid, bool translations) {
  return predicted_nested_bytes<FrictionDiscs>(elasticity, grid, tangential_kernel(), translations ? 3 : 1);
}

TangentialSolution solve_by_coulomb_method(const Elasticity& elasticity, const Grid& grid,
                                           const TangentialProblem& problem, const CoulombOptions& options) {
  require_valid(problem, grid);
  if ((problem.friction_bound == 0.0).all()) return unloaded(grid);
  NewtonOptions newton{.tolerance = options.tolerance, .max_applications = options.max_applications};
  if (options.progress) {
    newton.progress = [&](long applications, double gap) {
      options.progress(static_cast<int>(applications), gap);
    };
  }
  NestedSummary nested = solve_nested(elasticity, grid, TangentialOnGrid(grid, problem), newton);
  TangentialSolution solution;
  solution.status = nested.newton.converged ? Status::converged : Status::not_converged;
  if (!nested.newton.converged) {
    solution.message = fmt::format("{}: gap / energy {:.3g}, asked for {:.3g}", nested.newton.message,
                                   nested.newton.gap, options.tolerance);
  }
  describe_motion(solution, nested.newton, problem);
  solution.tangent_stiffness = turning_stiffness(nested.newton.tangent_stiffness, problem);
  solution.traction = std::move(nested.field);
  solution.elastic_displacement = std::move(nested.displacement);
  solution.change = nested.newton.gap;
  solution.iterations = nested.newton.iterations;
  solution.grids = std::move(nested.grids);
  solution.bytes = nested.bytes;
  describe(solution, problem, nested);
  return solution;
}

}  // namespace slipstick::solver
