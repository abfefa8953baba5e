#pragma once

#include <limits>

#include "solver/newton/admissible.hpp"
#include "solver/newton/load_balance.hpp"

namespace slipstick::solver {

/// The Euclidean projection onto the tractions within the discs that carry a moment, t.q = moment, is the
/// projection of q + alpha t onto the discs. Returns alpha; NaN where there is none.
inline double project_with_moment(Eigen::ArrayXd& q, const Eigen::ArrayXd& bound, const Grid& grid,
                                  double moment, double guess = 0.0) {
  const MotionField t(grid, 0.0, 0.0, 1.0);
  const FrictionDiscs discs(grid, bound);
  const LoadBalance balance(discs, {{&t, moment}});
  Coefficients alpha = Coefficients::Constant(1, guess);
  if (!balance.solve(q, alpha)) return std::numeric_limits<double>::quiet_NaN();
  balance.add(alpha, q);
  discs.project(q);
  return alpha[0];
}

}  // namespace slipstick::solver
