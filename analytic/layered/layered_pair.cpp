#include "analytic/layered/layered_pair.hpp"

#include <algorithm>
#include <limits>

#include "analytic/out_of_range.hpp"

namespace slipstick::analytic::layered {
namespace {

void require_elastic(const Elastic& material) {
  const auto& [modulus, nu] = material;
  if (!(modulus > 0)) out_of_range("shear modulus", modulus, "above 0");
  if (!(nu > -1 && nu <= 0.5)) out_of_range("Poisson's ratio", nu, "above -1, at most 1/2");
}

/// 4 exp(-2 x) (sinh(x)^2 - x^2), x >= 0.
double sinh_excess(double x) {
  const double decay = std::exp(-2 * x);
  if (x >= 1) return (1 - decay) * (1 - decay) - 4 * x * x * decay;
  double series = 1;  // of sinh(x) - x over x^3/6, to rounding
  for (int n = 17; n >= 5; n -= 2) series = 1 + x * x / (n * (n - 1)) * series;
  const double excess = x * x * x / 6 * series;
  return 4 * decay * excess * (2 * x + excess);
}

/// 1 - L exp(-x) is written as two positive terms for L next to 1.
double torsional(const Elastic& surface, const Coat& coat, double wave_number) {
  const double x = 2 * wave_number * coat.thickness;
  const double ratio = surface.shear_modulus / coat.base.shear_modulus;
  const double reflection = (ratio - 1) / (ratio + 1);
  return 2 * reflection * std::exp(-x) / (2 / (ratio + 1) - reflection * std::expm1(-x));
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
  const double denominator = below_a * below_b + a * below_b * rise * e + below_a * b * rise + a * sinh_excess(x);
  return e * (a + b + 4 * a * x * (1 + x) - 2 * a * b * e) / denominator;
}

template <class Excess>
double weighted(const std::array<Body, 2>& bodies, const std::array<double, 2>& weights, const Excess& excess) {
  double total = 0;
  for (std::size_t i = 0; i < 2; ++i)
    if (bodies[i].coat) total += weights[i] * excess(bodies[i].surface, *bodies[i].coat);
  return total / (weights[0] + weights[1]);
}

}  // namespace

Pair::Pair(const Body& first, const Body& second) : bodies_{first, second} {
  if (!first.coat && !second.coat) out_of_range("coated bodies", 0, "1 or 2");
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& [surface, coat] = bodies_[i];
    require_elastic(surface);
    tangential_[i] = 1 / surface.shear_modulus;
    normal_[i] = (1 - surface.poisson_ratio) / 2 * tangential_[i];
    if (!coat) continue;
    require_elastic(coat->base);
    require_positive("shear modulus of a layer", surface.shear_modulus);
    require_positive("thickness", coat->thickness);
  }
}

double Pair::thickness() const {
  const auto of = [](const Body& body) {
    return body.coat ? body.coat->thickness : std::numeric_limits<double>::infinity();
  };
  return std::min(of(bodies_[0]), of(bodies_[1]));
}

double Pair::normal_excess(double wave_number) const {
  return weighted(bodies_, normal_,
                  [&](const Elastic& surface, const Coat& coat) { return normal(surface, coat, wave_number); });
}

double Pair::torsional_excess(double wave_number) const {
  return weighted(bodies_, tangential_,
                  [&](const Elastic& surface, const Coat& coat) { return torsional(surface, coat, wave_number); });
}

}  // namespace slipstick::analytic::layered
