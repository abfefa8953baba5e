#pragma once

#include <vector>

#include "analytic/axisymmetric.hpp"
#include "analytic/layered/chebyshev_series.hpp"

namespace slipstick::analytic::layered {

/// p(r) = edge/sqrt(1 - r^2) + integral_r^1 x w(x^2)/sqrt(x^2 - r^2) dx, r over the contact radius, and its
///   H(s) = integral_s^1 p(r)/sqrt(r^2 - s^2) dr.
/// Hertz's pressure over its peak has w = 1, a flat punch's none.
class PressureIntegrals {
 public:
  /// detail: the length over the contact radius on which w changes, that of w's own singular points from the
  /// real axis being twice that. resolution: a factor of the numbers of points, 1 for all digits.
  PressureIntegrals(ChebyshevPanels weight, double edge, double detail, double resolution);

  /// Radius below which H(s) is a logarithm and a constant: what is left out goes like s^2 ln s, 1e-12 here.
  static constexpr double kSmallest = 0x1p-22;

  double pressure(double radius) const;
  /// H(s), and -H'(s).
  double integral(StickRadius s) const;
  double slope(StickRadius s) const;
  /// H(1), pi/2 times the edge term.
  double edge() const { return at_edge_; }
  /// 2 pi integral p r dr, and 8 integral s^2 H(s) ds, the limit moment over the friction.
  double load() const { return load_; }
  double moment_limit() const { return moment_limit_; }

  /// A radius s of a rule, with all digits of 1 - s.
  struct Node {
    StickRadius s;
    double weight;
    double integral;  ///< H(s)
  };
  /// Gauss's rule for the radii beyond c, and for those within.
  std::vector<Node> beyond(StickRadius c) const;
  std::vector<Node> within(StickRadius c) const;

  /// integral_c^1 -H'(s)/sqrt(s^2 - r^2) ds + H(1)/sqrt(1 - r^2), r = c - inward < c.
  double punches(StickRadius c, double radius, double inward) const;

  double detail() const { return detail_; }

 private:
  double smooth_integral(StickRadius s) const;
  std::vector<Node> nodes(double from, double to) const;

  ChebyshevPanels weight_;
  double edge_;
  double at_edge_;
  double detail_;
  std::size_t points_;
  ChebyshevPanels ellipse_;  // of r^2: (p - edge term)/sqrt(1 - r^2)
  ChebyshevPanels growth_;   // of 1 - s: (H(s) - H(1))/(1 - s)
  double load_ = 0;
  double moment_limit_ = 0;
};

}  // namespace slipstick::analytic::layered
