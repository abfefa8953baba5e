#pragma once

#include <functional>

#include "solver/contact/normal_contact.hpp"
#include "solver/contact/tangential_problem.hpp"
#include "solver/elasticity/elasticity.hpp"

namespace slipstick::solver {

/// Normal displacement by shear, u3 = K31 q1 + K32 q2, on a grid. Reciprocal to the pressure's tangential
/// displacement: K31(x) = K13(-x) = -K13(x).
class ShearOpening {
 public:
  ShearOpening(const Elasticity& elasticity, const Grid& grid) : op_(elasticity.make(grid, shear_kernel())) {}

  /// 2*cells values to cells values.
  Eigen::ArrayXd operator()(const Eigen::ArrayXd& traction) { return -op_->applied(traction); }

 private:
  Cached<LinearOperator> op_;
};

/// When a turn stops one of the two problems, and where it starts.
struct StaggeredTarget {
  double gap = 0.0;           ///< relative gap at which to stop; 0: the scene's tolerance
  Eigen::ArrayXd guess = {};  ///< a field near the answer; empty: none
};

/// A result as a function of the other problem's field.
template <class Result, class... Target>
using Under = std::function<Result(const Eigen::ArrayXd& field, const Target&... target)>;

/// Where the first turn starts.
struct CoupledGuess {
  Eigen::ArrayXd traction;       ///< 2*cells
  Eigen::ArrayXd pressure = {};  ///< empty: none
  double gap = 1e-2;             ///< relative gap at which the first turn stops
};

/// The two problems of a staggered iteration on the whole grid: each is solved with the last result of the
/// other problem.
struct CoupledProblem {
  const Eigen::ArrayXd& gap;  ///< undeformed; infinite where the bodies cannot touch
  CoupledGuess guess;
  double tolerance;  ///< on the complementarity gap
  /// Positive on a coarse grid: stop at this part of the first turn's gap, if that is above the tolerance.
  double part_of_first_gap = 0.0;
  Under<Eigen::ArrayXd> friction_bound;                        ///< under a pressure
  Under<NormalSolution, StaggeredTarget> solve_pressure;       ///< under an opening by shear
  Under<TangentialSolution, StaggeredTarget> solve_tractions;  ///< under a pressure
};

struct CoupledSolution {
  NormalSolution normal;
  TangentialSolution tangential;
  int turns = 0;
  double first_gap = 0.0;  ///< after the first turn
};

/// Panagiotopoulos' staggered iteration (1975) for the opening o = o(q) by shear:
///
/// 1. Pressure p under the opening o, then tractions q under p, both to a part of the last gap.
/// 2. Complementarity gap of p under the opening o(q) of the new tractions.
/// 3. Below the tolerance: q is solved to the scene's tolerance, if it has not been; stop if the gap still
///    holds.
/// 4. Otherwise o by Anderson's combination of the last openings, with a step that is halved where the gap
///    does not fall; again from 1.
///
/// Divergence is a status with its reason.
CoupledSolution solve_fully_coupled(const Elasticity& elasticity, const Grid& grid, const CoupledProblem& problem);

}  // namespace slipstick::solver
