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
  ShearOpening(const Elasticity& elasticity, const Grid& grid);

  /// 2*cells values to cells values.
  Eigen::ArrayXd operator()(const Eigen::ArrayXd& traction);

 private:
  Cached<LinearOperator> op_;
};

/// What a turn asks of one of the two problems.
struct TurnGoal {
  double gap = 0.0;           ///< over the energy, that is enough; 0: as well as it can be asked for
  Eigen::ArrayXd guess = {};  ///< a field near the answer; empty: none
};

/// The two problems that are solved in turns, each with the other's answer, on the whole grid.
struct CoupledProblem {
  Eigen::ArrayXd gap;       ///< undeformed; infinite where the bodies cannot touch
  Eigen::ArrayXd traction;  ///< guess, 2*cells
  double tolerance;         ///< on the complementarity gap
  std::function<Eigen::ArrayXd(const Eigen::ArrayXd& pressure)> friction_bound;
  std::function<NormalSolution(const Eigen::ArrayXd& opening, const TurnGoal&)> solve_pressure;
  std::function<TangentialSolution(const Eigen::ArrayXd& pressure, const TurnGoal&)> solve_tractions;
};

struct CoupledSolution {
  NormalSolution normal;
  TangentialSolution tangential;
  int turns = 0;
};

/// Panagiotopoulos' method (1975): pressure under the opening by shear, tractions under that pressure, and
/// again, until the pressure's complementarity gap holds with the opening of the last tractions. Each turn
/// starts from the last ones, is solved no better than its part of the gap, and ends in Anderson's
/// combination of them; the last tractions are solved as well as is asked for. Where the gap does not fall,
/// the opening follows by half, a quarter, ... of its change. A pressure that does not settle is a status
/// with its reason.
CoupledSolution solve_fully_coupled(const Elasticity& elasticity, const Grid& grid,
                                    const CoupledProblem& problem);

}  // namespace slipstick::solver
