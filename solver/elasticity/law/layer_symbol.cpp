#include "solver/elasticity/law/layer_symbol.hpp"

#include <algorithm>
#include <cmath>

namespace slipstick::solver {
namespace {

/// Wave number times thickness from which on exp(-2 x) is zero, and below which differences are series.
constexpr double kNothingLeft = 400.0;
constexpr double kSmall = 0.5;

/// The tail of the series of sinh or cosh from its power n on, whose first term is given; y = 2 x < 2 kSmall.
double tail(double term, double y, int n) {
  constexpr int kTerms = 9;  // 1/20! is below rounding
  double sum = 0.0;
  for (int i = 0; i < kTerms; ++i, n += 2) {
    sum += term;
    term *= y * y / ((n + 1.0) * (n + 2.0));
  }
  return sum;
}

}  // namespace

WaveCompliance wave_compliance(const CoatedBody& body, double wave_number) {
  const double compliance = 1.0 / body.surface.shear_modulus;
  const double plane = (1.0 - body.surface.poisson_ratio) * compliance;
  if (std::isinf(body.thickness)) return {compliance, plane, plane, (0.5 - body.surface.poisson_ratio) * compliance};
  const double mu = body.surface.shear_modulus / body.base.shear_modulus;
  const double k1 = 3.0 - 4.0 * body.surface.poisson_ratio;
  const double k2 = 3.0 - 4.0 * body.base.poisson_ratio;
  // With Burmister's constants a and b: (1 - a)(1 - b), 1 - a b, 1 + a b + 2 b, 1 + a b - 2 b.
  const double both = (1.0 + mu * k2) * (mu + k1);
  const double b = (mu - 1.0) / (mu + k1);
  const double bonded = (1.0 + k1) * (1.0 + k1) / both;
  const double open = mu * (1.0 + k1) * (1.0 + k2) / both;
  const double above = (4.0 * mu * mu * k2 + mu * (3.0 - k1) * (1.0 - k2) + 2.0 * (k1 - 1.0)) / both;
  const double below = (1.0 + k1) * (2.0 + mu * (k2 - 1.0)) / both;

  const double x = std::min(wave_number * body.thickness, kNothingLeft);
  const double e = std::exp(-2.0 * x);
  const double fall = -std::expm1(-2.0 * x);
  const double fall_twice = -std::expm1(-4.0 * x);
  const double y = 2.0 * x;
  // exp(-2 x) times sinh(2 x) - 2 x, and times cosh(2 x) - 1 - 2 x^2.
  const double sinh_excess = x < kSmall ? e * tail(y * y * y / 6.0, y, 3) : 0.5 * fall_twice - y * e;
  const double cosh_excess = x < kSmall ? e * tail(y * y * y * y / 24.0, y, 4) : 0.5 * fall * fall - 2.0 * x * x * e;

  const double denominator =
      bonded * e + (2.0 - open) * cosh_excess + 0.5 * open * fall_twice + 2.0 * below * x * x * e;
  const double common = 0.5 * open * (1.0 + e * e) + (2.0 - open) * sinh_excess;
  const double squeezed =
      (k1 - 1.0) * fall * (open + (1.0 - open) * fall) + e * (mu * (k2 - 1.0) * bonded + 8.0 * b * x * x);
  // Shear waves: L = (G1 - G2)/(G1 + G2), and 1 + L e over 1 - L e.
  const double shear = (mu - 1.0) / (mu + 1.0);
  return {.across = compliance * (2.0 * mu / (1.0 + mu) - shear * fall) / (2.0 / (1.0 + mu) + shear * fall),
          .along = plane * (common + y * e * below) / denominator,
          .normal = plane * (common + y * e * above) / denominator,
          .coupling = 0.25 * compliance * squeezed / denominator};
}

}  // namespace slipstick::solver
