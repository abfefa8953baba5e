#include "analytic/indentation.hpp"

#include <algorithm>
#include <initializer_list>
#include <numbers>
#include <utility>

#include "analytic/elliptic.hpp"
#include "analytic/gsl.hpp"
#include "analytic/out_of_range.hpp"

namespace slipstick::analytic {

namespace {

using std::numbers::pi;

void require_all_positive(std::initializer_list<std::pair<std::string_view, double>> numbers) {
  for (const auto& [name, value] : numbers) require_positive(name, value);
}

double mean_pressure(double load, double radius) { return load / radius / radius / pi; }

/// Gamma(n/2 + 1)/Gamma(n/2 + 1/2).
double gamma_ratio(double n) {
  constexpr double kLarge = 100;  // the asymptotic series' next term is below 1e-16
  if (n < kLarge) return std::tgamma(n / 2 + 1) / std::tgamma(n / 2 + 0.5);
  const double w = n / 2 + 0.25;
  const double i = 1 / (w * w);
  return std::sqrt(w) * (1 + i * (1.0 / 64 - i * (19.0 / 8192 - i * 631.0 / 524288)));
}

/// The a with a^(n + 1) = over_modulus/(kappa B).
double power_radius(double over_modulus, double kappa, double coefficient, double n) {
  const double power = over_modulus / kappa / coefficient;
  if (!std::isnormal(power))
    return std::exp((std::log(over_modulus) - std::log(kappa) - std::log(coefficient)) / (n + 1));
  const double a = std::pow(power, 1 / (n + 1));
  return a * (1 + (power / std::pow(a, n + 1) - 1) / (n + 1));  // 1/(n + 1) was rounded
}

/// ((1 + t^2) arctan t - t)/t^3 with t = s/b: 2/3 at t = 0, 0 as t -> infinity.
double corner_share(double b_over_s) {
  constexpr double kSeries = 2;  // from here on the powers of 1/4 converge, and the closed form would cancel
  constexpr int kTerms = 27;
  const double i = b_over_s;
  if (i < kSeries) return i * ((1 + i * i) * std::atan2(1.0, i) - i);
  double sum = 0;
  for (int k = kTerms; k-- > 0;) sum = 2.0 / ((2 * k + 1) * (2 * k + 3)) - sum / i / i;
  return sum;
}

/// With s^2 = a^2 - b^2, W = 4/3 E* s^3/R (1 - 3/4 corner_share(b/s)), so that s lies between the radius that
/// a sphere of radius R would have and cbrt(2) of it. All lengths over that one.
double corner_reach(double flat) {
  constexpr double kMargin = 1e-9;
  const auto excess = [flat](double s) { return s * s * s * (1 - 0.75 * corner_share(flat / s)) - 1; };
  return gsl::root(excess, 1 - kMargin, std::cbrt(2.0) + kMargin);
}

/// Short over long semi-axis of the contact of a gap with radii of curvature in the given ratio (>= 1). The
/// displacement's two curvatures, R_D(0, b^2, a^2) along a and R_D(0, a^2, b^2) along b, must stand in it.
double axis_ratio(double radius_ratio) {
  const auto mismatch = [radius_ratio](double t) {
    const double b2 = std::exp(2 * t);
    return std::log(carlson_rd(0, 1, b2) / carlson_rd(0, b2, 1) / radius_ratio);
  };
  // b/a is about radius_ratio^(-2/3), and always between the powers -1 and -1/2; the margin serves ratios near 1.
  constexpr double kMargin = 0.1;
  const double log_ratio = std::log(radius_ratio);
  return std::exp(gsl::root(mismatch, -log_ratio - kMargin, -log_ratio / 2 + kMargin));
}

}  // namespace

Indentation indent_sphere(double load, double radius, double effective_modulus) {
  require_all_positive({{"load", load}, {"radius", radius}, {"effective modulus", effective_modulus}});
  const double a = std::cbrt(3 * load * radius / (4 * effective_modulus));
  return {.contact_radius = a, .approach = a * a / radius, .reference_pressure = 3 * load / (2 * pi * a * a)};
}

Indentation indent_cone(double load, double slope, double effective_modulus) {
  require_all_positive({{"load", load}, {"slope", slope}, {"effective modulus", effective_modulus}});
  const double a = std::sqrt(load / effective_modulus * (2 / pi) / slope);
  return {.contact_radius = a, .approach = pi / 2 * slope * a, .reference_pressure = effective_modulus / 2 * slope};
}

Indentation indent_flat_punch(double load, double radius, double effective_modulus) {
  require_all_positive({{"load", load}, {"radius", radius}, {"effective modulus", effective_modulus}});
  return {.contact_radius = radius,
          .approach = load / effective_modulus / radius / 2,
          .reference_pressure = mean_pressure(load, radius) / 2};
}

Indentation indent_power(double load, double exponent, double coefficient, double effective_modulus) {
  require_all_positive(
      {{"load", load}, {"exponent", exponent}, {"coefficient", coefficient}, {"effective modulus", effective_modulus}});
  const double n = exponent;
  // Approach kappa B a^n, and W = 2 E* n/(n + 1) a times that.
  const double kappa = std::sqrt(pi) * gamma_ratio(n);
  const double over_modulus = load / effective_modulus * (n + 1) / (2 * n);
  const double a = power_radius(over_modulus, kappa, coefficient, n);
  return {
      .contact_radius = a, .approach = over_modulus / a, .reference_pressure = mean_pressure(load, a) * (n + 1) / 2};
}

RoundedPunchIndentation indent_rounded_punch(double load, double flat_radius, double corner_radius,
                                             double effective_modulus) {
  require_positive("load", load);
  if (!(flat_radius >= 0 && std::isfinite(flat_radius))) out_of_range("flat radius", flat_radius, ">= 0 and finite");
  require_positive("corner radius", corner_radius);
  require_positive("effective modulus", effective_modulus);
  const double sphere = indent_sphere(load, corner_radius, effective_modulus).contact_radius;
  const double s = sphere * corner_reach(flat_radius / sphere);
  const double a = std::hypot(flat_radius, s);
  // g(a) = a/R (s - b arctan(s/b)).
  const double approach = s / corner_radius * (s / a) * s * (1 - corner_share(flat_radius / s));
  return {.contact = {.contact_radius = a, .approach = approach, .reference_pressure = mean_pressure(load, a)},
          .flat_ratio = flat_radius / a};
}

HertzEllipse hertz_ellipse(double load, double radius_1, double radius_2, double effective_modulus) {
  require_all_positive(
      {{"load", load}, {"radius 1", radius_1}, {"radius 2", radius_2}, {"effective modulus", effective_modulus}});
  // The semi-ellipsoidal pressure's displacement (Johnson 1985, Eqs. (3.63) and (4.26)), its integrals as
  // Carlson's: curvature 1/R = W/(pi E*) R_D(0, b^2, a^2) along a, approach 3 W/(2 pi E*) R_F(0, a^2, b^2).
  const auto [small_radius, large_radius] = std::minmax(radius_1, radius_2);
  const double ratio = axis_ratio(large_radius / small_radius);
  const double b2 = ratio * ratio;
  const double a = std::cbrt(load * large_radius / (pi * effective_modulus) * carlson_rd(0, b2, 1));
  const double b = a * ratio;
  // The mean over the radii in one direction is 3 pi/16 of the ellipse's radius, the mean of that over the
  // directions a 2 E/pi.
  const double friction_arm = 3.0 / 8 * a * complete_elliptic(std::min(ratio, 1.0)).e;
  return {.semi_axis_1 = radius_1 < radius_2 ? b : a,
          .semi_axis_2 = radius_1 < radius_2 ? a : b,
          .peak_pressure = 3 * load / (2 * pi * a * b),
          .approach = 3 * load / (2 * pi * effective_modulus * a) * carlson_rf(0, b2, 1),
          .friction_arm = friction_arm};
}

}  // namespace slipstick::analytic
