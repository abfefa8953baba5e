#pragma once

#include <Eigen/Core>
#include <deque>

namespace slipstick::solver {

/// Anderson's acceleration (1965) of a fixed point x = G(x): the next x is the combination of the last ones
/// that would leave the least residual, r = G(x) - x, were G affine, and a step along that residual.
class Anderson {
 public:
  /// depth: steps that are combined, kMaxConditions at most; none: x only moves along its residual.
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
