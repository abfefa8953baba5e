#pragma once

#include <cmath>
#include <numbers>

namespace slipstick::solver {

/// An ellipse of contact by Hertz's theory as Johnson (1985, Eqs. 4.26 to 4.32) has it, with elliptic
/// integrals of the standard library: A/B from the axis ratio, which bisection inverts.
struct Ellipse {
  double major;  ///< along the direction of the larger radius of curvature
  double minor;
  double peak_pressure;
  double approach;
};

inline Ellipse johnson_ellipse(double load, double large_radius, double small_radius,
                               double effective_modulus) {
  // (R'/R'')^(1/2)^2 = ((a/b)^2 E(e) - K(e))/(K(e) - E(e)), Eq. (4.28), with e^2 = 1 - b^2/a^2.
  const auto radius_ratio = [](double e) {
    const double K = std::comp_ellint_1(e);
    const double E = std::comp_ellint_2(e);
    return (E / ((1.0 - e) * (1.0 + e)) - K) / (K - E);
  };
  double low = 1e-6;
  double high = 1.0 - 1e-12;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (radius_ratio(middle) < large_radius / small_radius ? low : high) = middle;
  }
  const double e = 0.5 * (low + high);
  const double K = std::comp_ellint_1(e);
  const double E = std::comp_ellint_2(e);
  const double b_over_a = std::sqrt((1.0 - e) * (1.0 + e));
  // A = 1/(2 R') = (p0/E*) (b/(e^2 a^2)) (K - E), Eq. (4.26a), with p0 = 3 W/(2 pi a b).
  const double a =
      std::cbrt(3.0 * load * large_radius / (std::numbers::pi * effective_modulus) * (K - E) / (e * e));
  const double p0 = 1.5 * load / (std::numbers::pi * a * a * b_over_a);
  return {a, a * b_over_a, p0, p0 / effective_modulus * a * b_over_a * K};  // Eq. (4.26c)
}

}  // namespace slipstick::solver
