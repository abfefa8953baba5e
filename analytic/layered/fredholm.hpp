#pragma once

#include <vector>

#include "analytic/gsl.hpp"

/// Fredholm's equations of the second kind whose kernel is analytic up to twice a layer's thickness off the real axis.
namespace slipstick::analytic::layered {

/// All digits, or fewer points on each panel, by whose answer the error is estimated.
enum class Points { all, fewer };

/// Ends of equal panels from 0 to length, at most `longest` each.
std::vector<double> panel_ends(double length, double longest);

struct Node {
  double x;
  double weight;
  double value = 0;
};
/// Gauss's rule of 20 points (18) on each panel. On panels of 4 h, with h the thickness, it leaves 5e-16
/// (2e-14) of a function like the kernel.
std::vector<Node> gauss_nodes(const std::vector<double>& ends, Points points);

template <class Function>
double sum(const std::vector<Node>& nodes, const Function& f) {
  double total = 0;
  for (const Node& node : nodes) total += node.weight * f(node.x);
  return total;
}

/// A function by 24 (22) Chebyshev terms on each panel. A panel of 2 h leaves 1e-15 of a function like the
/// kernel, and so does one from (2 n h)^2 to (2 n h + 2 h)^2 of an even function's square argument.
class PiecewisePolynomial {
 public:
  PiecewisePolynomial(const RealFunction& f, std::vector<double> ends, Points points);

  double operator()(double x) const;
  PiecewisePolynomial derivative() const;
  const std::vector<double>& ends() const { return ends_; }

 private:
  std::vector<double> ends_;
  std::vector<std::vector<double>> coefficients_;  // of each panel
};

/// k(x) = (1/pi) integral_0^inf excess(k) cos(k x) dk, which kernels are made of: even K(t, s) = k(t - s) +
/// k(t + s) for pressure, odd k(t - s) - k(t + s) for torsion.
class CosineTransform {
 public:
  /// For |x| <= reach, of an excess that falls like exp(-2 k h) and is smooth in ln k; lengths over `unit`.
  CosineTransform(const RealFunction& excess, double thickness, double reach, double unit, Points points);

  double operator()(double x) const { return unit_ * table_(unit_ * (x < 0 ? -x : x)); }
  double even(double t, double s) const { return (*this)(t - s) + (*this)(t + s); }
  double odd(double t, double s) const { return (*this)(t - s) - (*this)(t + s); }
  double thickness() const { return thickness_; }
  Points points() const { return points_; }

 private:
  double thickness_;
  Points points_;
  double unit_;
  PiecewisePolynomial table_;
};
/// CosineTransform's even or odd.
using Kernel = double (CosineTransform::*)(double t, double s) const;

/// Solves f(t) + integral_0^radius K(t, s) f(s) ds = right_side(t). It is known at Gauss's points, and by the
/// equation itself (Nystroem) anywhere else.
struct Solution {
  RealFunction right_side;
  const CosineTransform* transform;  ///< must outlive the solution
  Kernel kernel;
  std::vector<Node> nodes;

  double operator()(double t) const;
  /// integral of t^power f.
  double moment(int power) const;
};

/// One solution for each right side.
std::vector<Solution> solve_fredholm(const CosineTransform& transform, Kernel kernel, double radius,
                                     const std::vector<RealFunction>& right_sides);

}  // namespace slipstick::analytic::layered
