#pragma once

#include <slipstick/axisymmetric.hpp>

#include <cmath>
#include <numbers>

namespace example {

namespace analytic = slipstick::analytic;

/// The integral of a smooth function by Simpson's rule.
template <class Function>
double integral(const Function& f, double from, double to) {
  constexpr int kIntervals = 200;
  const double h = (to - from) / kIntervals;
  double sum = f(from) + f(to);
  for (int i = 1; i < kIntervals; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * f(from + i * h);
  return sum * h / 3.0;
}

/// p = p0 (1 - r^2): H(s) = (1 - s^2/2) arcosh(1/s) - sqrt(1 - s^2)/2, -H'(s) = s arcosh(1/s) + sqrt(1 -
/// s^2)/s.
class ParabolicPressure final : public analytic::Profile {
 public:
  ParabolicPressure()
      : Profile({.name = "parabolic",
                 .reference_pressure = "the pressure at the centre",
                 .load = std::numbers::pi / 2.0,  // 2 pi integral of r p
                 .moment_limit = 8.0 / 15.0}) {}  // 2 pi integral of r^2 p, over the load

  double pressure(double radius) const override { return 1.0 - radius * radius; }

  double twist_integral(analytic::StickRadius stick) const override {
    const double c = stick.ratio;
    const double w = root(stick);
    return (1.0 - 0.5 * c * c) * std::asinh(w / c) - 0.5 * w;
  }

  double twist_slope(analytic::StickRadius stick) const override {
    const double c = stick.ratio;
    const double w = root(stick);
    return c * c * std::asinh(w / c) + w;
  }

  /// (8/3) integral of s^3 (-H'(s)) over M_lim, with s = cos v; each of the two parts is a sum of positive
  /// terms.
  analytic::MomentShare moment_share(analytic::StickRadius stick) const override {
    const auto integrand = [](double v) {
      const double s = std::cos(v);
      const double w = std::sin(v);
      return (s > 0.0 ? std::pow(s, 4) * std::asinh(w / s) : 0.0) * w + s * s * w * w;
    };
    constexpr double kScale = 10.0 / std::numbers::pi;
    const double edge = std::atan2(root(stick), stick.ratio);
    return {.excess = kScale * integral(integrand, 0.0, edge),
            .deficit = kScale * integral(integrand, edge, std::numbers::pi / 2.0)};
  }

  /// (2/pi) r integral of -H'(s)/sqrt(s^2 - r^2) ds, with s^2 - r^2 = (1 - r^2) sin^2 u.
  double stick_traction(analytic::StickRadius stick, double radius, double inward) const override {
    const double reach = std::sqrt(1.0 - radius * radius);
    const auto integrand = [&](double u) {
      const double w = reach * std::cos(u);  // sqrt(1 - s^2)
      const double s = std::hypot(radius, reach * std::sin(u));
      return (std::asinh(w / s) + w / (s * s)) * w;
    };
    const double first = std::asin(std::sqrt(inward * (stick.ratio + radius)) / reach);
    return 2.0 / std::numbers::pi * radius * integral(integrand, first, std::numbers::pi / 2.0);
  }

 private:
  /// sqrt(1 - c^2), to all digits.
  static double root(analytic::StickRadius stick) { return std::sqrt(stick.complement * (1.0 + stick.ratio)); }
};

}  // namespace example
