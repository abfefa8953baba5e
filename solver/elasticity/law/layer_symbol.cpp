#include "solver/elasticity/law/layer_symbol.hpp"

#include <algorithm>
#include <cmath>

namespace slipstick::solver {
namespace {

/// Wave number times thickness from which on exp(-2 x) is zero, and below which differences are summed as
/// series.
constexpr double kNothingLeft = 400.0;
constexpr double kSmall = 0.5;

/// Series of terms that each follow from the one before, up to where they no longer count: x < kSmall.
double power_series(double term, double square, int from) {
  constexpr int kTerms = 10;  // 0.5^20/20! is below rounding
  double sum = 0.0;
  for (int n = from; n < from + 2 * kTerms; n += 2) {
    sum += term;
    term *= square / ((n + 1.0) * (n + 2.0));
  }
  return sum;
}

/// exp(-2 x) times sinh(2 x) - 2 x.
double scaled_sinh_excess(double x, double decay) {
  if (x >= kSmall) return -0.5 * std::expm1(-4.0 * x) - 2.0 * x * decay;
  const double square = 4.0 * x * x;
  return decay * power_series(2.0 * x * square / 6.0, square, 3);
}

/// exp(-2 x) times sinh(x)^2 - x^2.
double scaled_square_excess(double x, double decay) {
  const double fall = std::expm1(-2.0 * x);
  if (x >= kSmall) return 0.25 * fall * fall - x * x * decay;
  const double square = 4.0 * x * x;
  return decay * 0.5 * power_series(square * square / 24.0, square, 4);
}

WaveCompliance of_half_space(const HalfSpace& body) {
  const double compliance = 1.0 / body.shear_modulus;
  const double nu = body.poisson_ratio;
  const double plane = (1.0 - nu) * compliance;
  return {compliance, plane, plane, 0.5 * (1.0 - 2.0 * nu) * compliance};
}

}  // namespace

WaveCompliance of_pair(const WaveCompliance& lower, const WaveCompliance& upper) {
  return {lower.across + upper.across, lower.along + upper.along, lower.normal + upper.normal,
          lower.coupling - upper.coupling};
}

/// What both compliances are made of, x the product of wave number and thickness.
struct LayerSymbol::Terms {
  double x;
  double decay;              ///< e = exp(-2 x)
  double fall;               ///< 1 - e
  double denominator;        ///< 1 - (lambda + kappa + 4 kappa x^2) e + lambda kappa e^2
  double shear;              ///< (G1 - G2)/(G1 + G2) = L
  double shear_denominator;  ///< 1 - L e
};

LayerSymbol::LayerSymbol(const CoatedBody& body)
    : coated_(body.layer.has_value()),
      surface_(of_half_space(body.surface())),
      shear_compliance_(surface_.across),
      along_(surface_.along) {
  if (!coated_) return;
  const double nu1 = body.surface().poisson_ratio;
  const double nu2 = body.base.poisson_ratio;
  const double mu = body.surface().shear_modulus / body.base.shear_modulus;
  const double k1 = 3.0 - 4.0 * nu1;
  const double k2 = 3.0 - 4.0 * nu2;
  const double both = (1.0 + mu * k2) * (mu + k1);
  thickness_ = body.layer->thickness;
  ratio_ = mu;
  lambda_ = (mu * k2 - k1) / (1.0 + mu * k2);
  kappa_ = (mu - 1.0) / (mu + k1);
  one_less_lambda_ = (1.0 + k1) / (1.0 + mu * k2);
  one_less_kappa_ = (1.0 + k1) / (mu + k1);
  one_less_product_ = mu * (1.0 + k1) * (1.0 + k2) / both;
  less_two_kappa_ = (1.0 + k1) * (2.0 + mu * (k2 - 1.0)) / both;
  plus_two_kappa_ = (4.0 * mu * mu * k2 + mu * (3.0 - k1) * (1.0 - k2) + 2.0 * (k1 - 1.0)) / both;
  base_coupling_ = mu * (1.0 - 2.0 * nu2);
  layer_coupling_ = 1.0 - 2.0 * nu1;
}

LayerSymbol::Terms LayerSymbol::terms(double wave_number) const {
  const double x = std::min(wave_number * thickness_, kNothingLeft);
  const double e = std::exp(-2.0 * x);
  const double fall = -std::expm1(-2.0 * x);
  const double shear = (ratio_ - 1.0) / (ratio_ + 1.0);
  return {.x = x,
          .decay = e,
          .fall = fall,
          .denominator = one_less_lambda_ * one_less_kappa_ * e +
                         2.0 * (2.0 - one_less_product_) * scaled_square_excess(x, e) -
                         0.5 * one_less_product_ * std::expm1(-4.0 * x) + 2.0 * less_two_kappa_ * x * x * e,
          .shear = shear,
          .shear_denominator = 2.0 / (1.0 + ratio_) + shear * fall};
}

WaveCompliance LayerSymbol::whole(double wave_number) const {
  if (!coated_) return surface_;
  const Terms t = terms(wave_number);
  const double e = t.decay;
  const double common =
      0.5 * one_less_product_ * (1.0 + e * e) + (2.0 - one_less_product_) * scaled_sinh_excess(t.x, e);
  const double normal = common + 2.0 * plus_two_kappa_ * t.x * e;
  const double along = common + 2.0 * less_two_kappa_ * t.x * e;
  const double coupling =
      layer_coupling_ * t.fall * (one_less_product_ + lambda_ * kappa_ * t.fall) +
      e * (base_coupling_ * one_less_lambda_ * one_less_kappa_ + 4.0 * kappa_ * t.x * t.x);
  return {
      .across = shear_compliance_ * (2.0 * ratio_ / (1.0 + ratio_) - t.shear * t.fall) / t.shear_denominator,
      .along = along_ * along / t.denominator,
      .normal = along_ * normal / t.denominator,
      .coupling = 0.5 * shear_compliance_ * coupling / t.denominator};
}

WaveCompliance LayerSymbol::beyond_layer(double wave_number) const {
  if (!coated_) return {};
  const Terms t = terms(wave_number);
  const double square = t.x * t.x;
  const double scale = t.decay / t.denominator;
  const double common = lambda_ * one_less_kappa_ + kappa_ * one_less_lambda_ +
                        2.0 * lambda_ * kappa_ * t.fall + 4.0 * kappa_ * square;
  const double coupling = one_less_lambda_ * one_less_kappa_ * (base_coupling_ - layer_coupling_) +
                          4.0 * kappa_ * (1.0 + layer_coupling_) * square;
  return {.across = 2.0 * shear_compliance_ * t.shear * t.decay / t.shear_denominator,
          .along = along_ * scale * (common - 4.0 * kappa_ * t.x),
          .normal = along_ * scale * (common + 4.0 * kappa_ * t.x),
          .coupling = 0.5 * shear_compliance_ * scale * coupling};
}

}  // namespace slipstick::solver
