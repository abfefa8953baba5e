#include "solver/elasticity/law/hankel_table.hpp"

#include <gsl/gsl_fft_real.h>
#include <gsl/gsl_sf_gamma.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>

namespace slipstick::solver {
namespace {

using Complex = std::complex<double>;
constexpr double kPi = std::numbers::pi;

/// s(x) sqrt(x) is a function of ln x, sampled over one period. It falls to rounding at both ends: like
/// exp(-2 x) above, like sqrt(x) below, with room for what the largest r asks for.
constexpr std::size_t kSamples = 2048;
constexpr double kLargest = 25.0;
constexpr double kPeriod = 112.0;
constexpr double kStep = 2.0 * kPi / kPeriod;
/// Frequencies up to 45. Those above are below rounding where s is analytic 45 degrees off the axis.
constexpr std::size_t kFrequencies = 802;
/// End of the first interval, and half octaves after it.
constexpr double kFirst = 0.5;
constexpr Index kHalfOctaves = 52;

/// Integral over x > 0 of x^z J_m(x) (Abramowitz and Stegun, Eq. 11.4.16).
Complex power_integral(Complex z, int order) {
  const auto log_gamma = [](Complex at) {
    gsl_sf_result size;
    gsl_sf_result angle;
    gsl_sf_lngamma_complex_e(at.real(), at.imag(), &size, &angle);
    return Complex(size.val, angle.val);
  };
  const double m = order;
  return std::exp(z * std::numbers::ln2 + log_gamma(0.5 * (1.0 + m + z)) - log_gamma(0.5 * (1.0 + m - z)));
}

/// The powers x^(-1/2 + i w) that make up each s have integrals in closed form: each term of the table is
/// r^(-1/2) times the real part of the sum of these coefficients times exp(-i w ln r).
std::array<std::vector<Complex>, HankelTable::kTerms> series_of(
    const std::array<int, HankelTable::kTerms>& orders,
    const std::function<HankelTable::Values(double)>& spectrum) {
  const double first = std::log(kLargest) - kPeriod;
  std::array<std::vector<double>, HankelTable::kTerms> samples;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const double x = std::exp(first + kPeriod / static_cast<double>(kSamples) * static_cast<double>(i));
    const HankelTable::Values s = spectrum(x);
    for (std::size_t term = 0; term < s.size(); ++term) samples[term].push_back(s[term] * std::sqrt(x));
  }
  std::array<std::vector<Complex>, HankelTable::kTerms> series;
  for (std::size_t term = 0; term < series.size(); ++term) {
    const std::vector<double>& a = samples[term];
    gsl_fft_real_radix2_transform(samples[term].data(), 1, kSamples);
    for (std::size_t n = 0; n < kFrequencies; ++n) {
      const double w = kStep * static_cast<double>(n);
      const Complex sum = n == 0 ? 0.5 * a[0] : Complex(a[n], a[kSamples - n]);
      series[term].push_back(2.0 / static_cast<double>(kSamples) * sum * std::polar(1.0, -w * first) *
                             power_integral({-0.5, w}, orders[term]));
    }
  }
  return series;
}

}  // namespace

HankelTable::HankelTable(const std::array<int, kTerms>& orders,
                         const std::function<Values(double x)>& spectrum) {
  const auto series = series_of(orders, spectrum);
  constexpr auto n = static_cast<double>(kCoefficients);
  for (Index interval = 0; interval <= kHalfOctaves; ++interval) {
    const double end = kFirst * std::pow(2.0, 0.5 * static_cast<double>(interval));
    const double begin = interval == 0 ? 0.0 : end / std::numbers::sqrt2;
    middle_.push_back(0.5 * (begin + end));
    half_width_.push_back(0.5 * (end - begin));
    coefficients_.resize(coefficients_.size() + kTerms * kCoefficients);
    double* const coefficients = coefficients_.data() + coefficients_.size() - kTerms * kCoefficients;
    for (std::size_t j = 0; j < kCoefficients; ++j) {
      const double angle = kPi * (static_cast<double>(j) + 0.5) / n;
      const double r = middle_.back() + half_width_.back() * std::cos(angle);
      const Complex turn = std::polar(1.0, -kStep * std::log(r));
      Complex wave = 1.0 / std::sqrt(r);
      Values sum{};
      for (std::size_t i = 0; i < kFrequencies; ++i, wave *= turn) {
        for (std::size_t term = 0; term < kTerms; ++term) sum[term] += (series[term][i] * wave).real();
      }
      for (std::size_t k = 0; k < kCoefficients; ++k) {
        const double weight = (k == 0 ? 1.0 : 2.0) / n * std::cos(static_cast<double>(k) * angle);
        for (std::size_t term = 0; term < kTerms; ++term)
          coefficients[term * kCoefficients + k] += weight * sum[term];
      }
    }
  }
}

HankelTable::Place HankelTable::place(double r) const {
  std::size_t interval = 0;
  double scale = 1.0;
  if (r > kFirst) {
    const double end = middle_.back() + half_width_.back();
    if (r > end) {
      scale = end / r;
      r = end;
    }
    // Two intervals for each power of two, read off the number's bits.
    const auto bits = std::bit_cast<std::uint64_t>(r / kFirst);
    const double mantissa = std::bit_cast<double>((bits & 0xFFFFFFFFFFFFFU) | 0x3FF0000000000000U);
    interval = 2 * ((bits >> 52U) - 1023) + (mantissa < std::numbers::sqrt2 ? 1 : 2);
    interval = std::min(interval, middle_.size() - 1);
  }
  return {coefficients_.data() + interval * kTerms * kCoefficients,
          (r - middle_[interval]) / half_width_[interval], scale};
}

}  // namespace slipstick::solver
