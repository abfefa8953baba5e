#include "analytic/paper_equations.hpp"

#include <gsl/gsl_sf_ellint.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "analytic/gsl.hpp"
#include "analytic/out_of_range.hpp"

namespace slipstick::analytic {

namespace {

using std::numbers::pi;

// GSL takes the amplitude first, the paper the modulus.
double incomplete_f(double k, double phi) { return gsl::evaluate(gsl_sf_ellint_F_e, phi, k); }
double incomplete_e(double k, double phi) { return gsl::evaluate(gsl_sf_ellint_E_e, phi, k); }
double complete_k(double k) { return gsl::evaluate(gsl_sf_ellint_Kcomp_e, k); }
double complete_e(double k) { return gsl::evaluate(gsl_sf_ellint_Ecomp_e, k); }

void require(bool allowed, std::string_view name, double value, std::string_view range) {
  if (!allowed) out_of_range(name, value, range);
}

void require_partial_slip(double stick_ratio) {
  require(stick_ratio > 0 && stick_ratio < 1, "a_s/a", stick_ratio, "0 < a_s/a < 1");
}

void require_moment(double moment, double most, std::string_view range) {
  require(moment >= 0 && moment <= most, "M/(mu W a)", moment, range);
}

/// k of Eq. (2).
double modulus(double stick_ratio) { return std::sqrt(1 - stick_ratio * stick_ratio); }

/// Eq. (2)'s phi.
double amplitude(double stick_ratio, double radius) {
  const double c2 = stick_ratio * stick_ratio;
  const double r2 = radius * radius;
  // At r = 0 the sine is 1, up to rounding.
  return std::asin(std::min(1.0, std::sqrt((c2 - r2) / (1 - r2)) / stick_ratio));
}

/// Eq. (3).
double d(double k) {
  require(k > 0 && k < 1, "k", k, "0 < k < 1");
  return (complete_k(k) - complete_e(k)) / (k * k);
}

/// Eq. (1) with a factor on its stick branch.
double eq1_with(double factor, double stick_ratio, double radius) {
  require_partial_slip(stick_ratio);
  require(radius >= 0 && radius <= 1, "r/a", radius, "0 <= r/a <= 1");
  const double sliding = std::sqrt(1 - radius * radius);
  if (radius > stick_ratio) return sliding;
  const double k = modulus(stick_ratio);
  const double phi = amplitude(stick_ratio, radius);
  return factor * sliding *
         (pi / 2 + k * k * d(k) * incomplete_f(stick_ratio, phi) - complete_k(k) * incomplete_e(stick_ratio, phi));
}

constexpr double kNoSlipStiffness = 16.0 / 3;  // over G a^3
constexpr double kCap = 2.0 / 3;               // over mu W a

}  // namespace

namespace paper {

double eq1_printed(double stick_ratio, double radius) { return eq1_with(1, stick_ratio, radius); }

double eq1(double stick_ratio, double radius) { return eq1_with(2 / pi, stick_ratio, radius); }

double eq4_twist(double stick_ratio) {
  require_partial_slip(stick_ratio);
  const double k = modulus(stick_ratio);
  return 3 / (4 * pi) * k * k * d(k);
}

double eq5_moment(double stick_ratio) {
  require_partial_slip(stick_ratio);
  const double c = stick_ratio;
  const double k = modulus(c);
  const double k2 = k * k;
  const double d_k = d(k);
  const double big_k = complete_k(k);
  const auto integral = [c](double power) {
    return gsl::integral(
        [c, power](double alpha) {
          const double x = c * std::sin(alpha);
          return std::asin(x) / std::pow(1 - x * x, power);
        },
        0, pi / 2);
  };
  return (3 * pi * pi / 4 + c * k2 * (6 * big_k + (4 * c * c - 3) * d_k) - 3 * k * big_k * std::asin(c) -
          3 * k2 * (big_k * integral(1.5) - d_k * integral(0.5))) /
         (4 * pi);
}

double eq6_moment_limit() { return 3 * pi / 16; }

double eq7_twist(double moment) {
  require_moment(moment, 2.0 / 3, "0 <= M/(mu W a) <= 2/3");
  const double root = std::sqrt(1 - 3 * moment / 2);
  return (1 - root) * (3 - root) / 8;
}

}  // namespace paper

double no_slip_twist(double moment) {
  require_moment(moment, paper::eq6_moment_limit(), "0 <= M/(mu W a) <= 3 pi/16");
  return moment / kNoSlipStiffness;
}

double small_moment_twist(double moment) { return no_slip_twist(moment) + 9.0 / 64 * moment * moment; }

double dem_moment_limit() { return kCap; }

double dem_moment(double twist) {
  require(twist >= 0, "G a^2 phi/(mu W)", twist, "0 or more");
  return std::min(kNoSlipStiffness * twist, kCap);
}

double dem_twist(double moment) {
  require_moment(moment, kCap, "0 <= M/(mu W a) <= 2/3");
  return moment / kNoSlipStiffness;
}

std::span<const Approximation> approximations() {
  static constexpr std::array kAll{
      Approximation{"equation_7", "Eq. (7)", paper::eq7_twist}, Approximation{"no_slip", "no slip", no_slip_twist},
      Approximation{"small_moments", "small moments", small_moment_twist}, Approximation{"dem", "DEM", dem_twist}};
  return kAll;
}

}  // namespace slipstick::analytic
