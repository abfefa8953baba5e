#pragma once

#include <Eigen/Core>
#include <deque>

namespace slipstick::solver {

/// Anderson's acceleration (1965) of a fixed point x = G(x):
///
/// 1. Residual r = G(x) - x, and the last changes of x and r.
/// 2. The combination of the last x whose residual, for an affine G, is least.
/// 3. The next x: that combination plus a step along its residual.
class Anderson {
 public:
  /// depth: number of steps that are combined, at most kMaxConditions; with 0 x moves along its residual.
  explicit Anderson(int depth) : depth_(depth) {}

  /// From x, whose residual is given, to the next x; step: the part of the residual that x moves by.
  void advance(Eigen::ArrayXd& x, const Eigen::ArrayXd& residual, double step);

 private:
  struct Point {
    Eigen::ArrayXd x, residual;
  };
  int depth_;
  Point last_;
  std::deque<Point> changes_;  ///< from each point to the next, the latest first
};

}  // namespace slipstick::solver
