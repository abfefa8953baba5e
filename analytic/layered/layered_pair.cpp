#include "analytic/layered/layered_pair.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace slipstick::analytic::layered {
namespace {

void require(bool allowed, const char* name, double value, const char* range) {
  if (!allowed) throw std::domain_error(fmt::format("{} = {}; allowed: {}", name, value, range));
}

void require_elastic(const Elastic& material) {
  require(material.shear_modulus > 0, "shear modulus", material.shear_modulus, "above 0");
  require(material.poisson_ratio > -1 && material.poisson_ratio <= 0.5, "Poisson's ratio",
          material.poisson_ratio, "above -1, at most 1/2");
}

void require_body(const Body& body) {
  require_elastic(body.surface);
  if (!body.coat) return;
  require_elastic(body.coat->base);
  require(std::isfinite(body.surface.shear_modulus), "shear modulus of a layer", body.surface.shear_modulus,
          "finite");
  require(body.coat->thickness > 0 && std::isfinite(body.coat->thickness), "thickness of a layer",
          body.coat->thickness, "above 0, finite");
}

/// sinh(x)^2 - x^2 over exp(2 x)/4, x >= 0.
double scaled_sinh_excess(double x) {
  constexpr double kSmall = 1;  // below, the series of sinh(x) - x is exact to rounding in its eight terms
  const double decay = std::exp(-2 * x);
  if (x >= kSmall) return (1 - decay) * (1 - decay) - 4 * x * x * decay;
  double series = 1;
  for (int n = 17; n >= 5; n -= 2) series = 1 + x * x / (n * (n - 1)) * series;
  const double excess = x * x * x / 6 * series;
  return 4 * decay * excess * (2 * x + excess);
}

double torsional(const Elastic& surface, const Coat& coat, double wave_number) {
  const double x = 2 * wave_number * coat.thickness;
  const double ratio = surface.shear_modulus / coat.base.shear_modulus;
  const double reflection = (ratio - 1) / (ratio + 1);
  // 1 - L exp(-x), of two positive terms where L is next to 1
  const double denominator = 2 / (ratio + 1) - reflection * std::expm1(-x);
  return 2 * reflection * std::exp(-x) / denominator;
}

/// With x = k h, e = exp(-2 x), m = G/G_base, A = (m - 1)/(m + 3 - 4 nu), B = 1 - 4 (1 - nu)/(1 + m (3 - 4
/// nu_base)), the surface of layer and base moves as the layer's half-space times
///   (1 + 4 A x e - A B e^2)/(1 - (A + B + 4 A x^2) e + A B e^2).
/// The excess over 1 is e (A + B + 4 A x (1 + x) - 2 A B e) over the same denominator, written here in
/// 1 - A, 1 - B and 1 - e: on a soft base and for small x it is the small rest of large terms.
double normal(const Elastic& surface, const Coat& coat, double wave_number) {
  const double x = wave_number * coat.thickness;
  const double e = std::exp(-2 * x);
  const double rise = -std::expm1(-2 * x);
  const double m = surface.shear_modulus / coat.base.shear_modulus;
  const double nu = surface.poisson_ratio;
  const double below_a = 4 * (1 - nu) / (m + 3 - 4 * nu);
  const double below_b = 4 * (1 - nu) / (1 + m * (3 - 4 * coat.base.poisson_ratio));
  const double a = (m - 1) / (m + 3 - 4 * nu);
  const double b = 1 - below_b;
  const double denominator =
      below_a * below_b + a * below_b * rise * e + below_a * b * rise + a * scaled_sinh_excess(x);
  return e * (a + b + 4 * a * x * (1 + x) - 2 * a * b * e) / denominator;
}

}  // namespace

Pair::Pair(const Body& first, const Body& second) : bodies_{first, second}, normal_{}, tangential_{} {
  for (int i = 0; i < 2; ++i) {
    require_body(bodies_[i]);
    tangential_[i] = 1 / bodies_[i].surface.shear_modulus;
    normal_[i] = (1 - bodies_[i].surface.poisson_ratio) / 2 * tangential_[i];
  }
  require(first.coat || second.coat, "coated bodies", 0, "1 or 2");
}

double Pair::thickness() const {
  double least = std::numeric_limits<double>::infinity();
  for (const Body& body : bodies_)
    if (body.coat) least = std::min(least, body.coat->thickness);
  return least;
}

double Pair::normal_excess(double wave_number) const {
  double sum = 0;
  for (int i = 0; i < 2; ++i)
    if (bodies_[i].coat) sum += normal_[i] * normal(bodies_[i].surface, *bodies_[i].coat, wave_number);
  return sum * effective_modulus();
}

double Pair::torsional_excess(double wave_number) const {
  double sum = 0;
  for (int i = 0; i < 2; ++i)
    if (bodies_[i].coat) sum += tangential_[i] * torsional(bodies_[i].surface, *bodies_[i].coat, wave_number);
  return sum * shear_modulus();
}

}  // namespace slipstick::analytic::layered
