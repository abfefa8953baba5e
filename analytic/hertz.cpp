#include "analytic/hertz.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string_view>

#include "analytic/elliptic.hpp"
#include "analytic/gsl.hpp"

namespace slipstick::analytic {

namespace {

using std::numbers::pi;

void require_positive(std::string_view name, double value) {
  if (!(value > 0 && std::isfinite(value)))
    throw std::domain_error(fmt::format("{} = {}; allowed: positive and finite", name, value));
}

/// Short over long semi-axis of the contact of a gap with radii of curvature in the given ratio (>= 1).
/// The displacement's two curvatures, R_D(0, b^2, a^2) along a and R_D(0, a^2, b^2) along b, must stand in
/// it.
double axis_ratio(double radius_ratio) {
  const auto mismatch = [radius_ratio](double t) {
    const double b2 = std::exp(2 * t);
    return std::log(carlson_rd(0, 1, b2) / carlson_rd(0, b2, 1) / radius_ratio);
  };
  // b/a is about radius_ratio^(-2/3), and always between the powers -1 and -1/2; the margin serves ratios
  // near 1.
  constexpr double kMargin = 0.1;
  const double log_ratio = std::log(radius_ratio);
  return std::exp(gsl::root(mismatch, -log_ratio - kMargin, -log_ratio / 2 + kMargin));
}

}  // namespace

HertzCircle hertz_circle(double load, double sphere_radius, double effective_modulus) {
  require_positive("load", load);
  require_positive("sphere radius", sphere_radius);
  require_positive("effective modulus", effective_modulus);
  const double a = std::cbrt(3 * load * sphere_radius / (4 * effective_modulus));
  return {.radius = a, .peak_pressure = 3 * load / (2 * pi * a * a), .approach = a * a / sphere_radius};
}

HertzEllipse hertz_ellipse(double load, double radius_1, double radius_2, double effective_modulus) {
  require_positive("load", load);
  require_positive("radius 1", radius_1);
  require_positive("radius 2", radius_2);
  require_positive("effective modulus", effective_modulus);
  // The semi-ellipsoidal pressure's displacement (Johnson 1985, Eqs. (3.63) and (4.26)), its integrals as
  // Carlson's: curvature 1/R = W/(pi E*) R_D(0, b^2, a^2) along a, approach 3 W/(2 pi E*) R_F(0, a^2, b^2).
  const auto [small_radius, large_radius] = std::minmax(radius_1, radius_2);
  const double ratio = axis_ratio(large_radius / small_radius);
  const double b2 = ratio * ratio;
  const double a = std::cbrt(load * large_radius / (pi * effective_modulus) * carlson_rd(0, b2, 1));
  const double b = a * ratio;
  return {.semi_axis_1 = radius_1 < radius_2 ? b : a,
          .semi_axis_2 = radius_1 < radius_2 ? a : b,
          .peak_pressure = 3 * load / (2 * pi * a * b),
          .approach = 3 * load / (2 * pi * effective_modulus * a) * carlson_rf(0, b2, 1)};
}

}  // namespace slipstick::analytic
