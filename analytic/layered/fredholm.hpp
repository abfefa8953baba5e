#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "analytic/layered/chebyshev_series.hpp"

namespace slipstick::analytic::layered {

/// k(x) = (1/pi) integral_0^inf excess(k) cos(k x) dk, from which the kernels of the integral equations are
/// made: even K(t, s) = k(t - s) + k(t + s) for pressure, odd k(t - s) - k(t + s) for torsion.
class CosineTransform {
 public:
  /// For |x| <= reach; the excess falls like exp(-2 k thickness), and is smooth in ln k. resolution: a factor
  /// of the numbers of points, 1 for all digits.
  CosineTransform(const std::function<double(double)>& excess, double thickness, double reach,
                  double resolution);

  /// The same with lengths over a unit.
  CosineTransform over(double unit) const;

  double operator()(double x) const { return unit_ * (*table_)(unit_ * std::abs(x)); }
  double thickness() const { return thickness_ / unit_; }
  double resolution() const { return resolution_; }

 private:
  std::shared_ptr<const ChebyshevPanels> table_;
  double thickness_;
  double resolution_;
  double unit_ = 1;
};

enum class Parity { even, odd };

/// A smooth function on [0, radius] that solves f(t) + integral_0^radius K(t, s) f(s) ds = right_side(t),
/// known at Gauss's points and from the equation itself anywhere else.
class Solution {
 public:
  double operator()(double t) const;
  /// integral of weight f.
  double integral(const std::function<double(double)>& weight) const;

  struct Node {
    double t;
    double weight;
    double value;
  };
  std::function<double(double)> right_side;
  std::shared_ptr<const CosineTransform> transform;
  Parity parity;
  std::vector<Node> nodes;
};

double kernel(const CosineTransform& transform, Parity parity, double t, double s);

/// By Nystroem's method with Gauss's points, one solution for each right side.
std::vector<Solution> solve_fredholm(const std::shared_ptr<const CosineTransform>& transform, Parity parity,
                                     double radius,
                                     const std::vector<std::function<double(double)>>& right_sides);

}  // namespace slipstick::analytic::layered
