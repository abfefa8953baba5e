#pragma once

#include <Eigen/Core>
#include <deque>

#include "solver/newton/coefficients.hpp"

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
  void advance(Eigen::ArrayXd& x, const Eigen::ArrayXd& residual, double step) {
    if (last_.x.size() > 0) changes_.push_front({x - last_.x, residual - last_.residual});
    if (changes_.size() > static_cast<std::size_t>(depth_)) changes_.pop_back();
    last_ = {x, residual};
    x += step * residual;

    const auto count = static_cast<Index>(changes_.size());
    CoefficientMatrix products(count, count);
    Coefficients right(count);
    for (Index i = 0; i < count; ++i) {
      const Eigen::ArrayXd& change = changes_[static_cast<std::size_t>(i)].residual;
      right[i] = (change * residual).sum();
      for (Index j = 0; j < count; ++j) {
        products(i, j) = (change * changes_[static_cast<std::size_t>(j)].residual).sum();
      }
    }
    const Coefficients back = least_solution(products, right);
    if (!back.allFinite()) return;
    for (Index i = 0; i < count; ++i) {
      const Point& change = changes_[static_cast<std::size_t>(i)];
      x -= back[i] * (change.x + step * change.residual);
    }
  }

 private:
  struct Point {
    Eigen::ArrayXd x, residual;
  };
  int depth_;
  Point last_;
  std::deque<Point> changes_;  ///< from each point to the next, the latest first
};

}  // namespace slipstick::solver
