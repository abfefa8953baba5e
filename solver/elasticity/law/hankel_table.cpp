#include "solver/elasticity/law/hankel_table.hpp"

#include <gsl/gsl_fft_real.h>
#include <gsl/gsl_sf_gamma.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <utility>

namespace slipstick::solver {
namespace {

using Complex = std::complex<double>;
constexpr double kPi = std::numbers::pi;

/// s(x) sqrt(x) is sampled as a function of ln x over one period. It falls to rounding at both ends, like
/// exp(-2 x) above and like sqrt(x) below, there with a margin for the largest r.
constexpr Index kSamples = HankelTable::kSamples;
constexpr double kLargest = 25.0;
constexpr double kPeriod = 112.0;
const double kFirstSample = std::log(kLargest) - kPeriod;
constexpr double kFrequencyStep = 2.0 * kPi / kPeriod;
/// Frequencies up to 45. Higher ones have amplitudes below rounding if s is analytic 45 degrees off the axis.
constexpr Index kFrequencies = 802;
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

/// The powers x^(-1/2 + i w) that make up each s have integrals in closed form: each integral is r^(-1/2)
/// times the real part of the sum of these coefficients, one a column, times exp(-i w ln r).
Eigen::Array4Xcd series_of(const std::array<int, 4>& orders, Eigen::ArrayX4d samples) {
  for (Index i = 0; i < kSamples; ++i) samples.row(i) *= std::sqrt(HankelTable::sample_point(i));
  Eigen::Array4Xcd series(4, kFrequencies);
  for (Index term = 0; term < 4; ++term) {
    double* const a = samples.col(term).data();
    gsl_fft_real_radix2_transform(a, 1, kSamples);
    for (Index n = 0; n < kFrequencies; ++n) {
      const double w = kFrequencyStep * static_cast<double>(n);
      const Complex sum = n == 0 ? 0.5 * a[0] : Complex(a[n], a[kSamples - n]);
      series(term, n) = 2.0 / static_cast<double>(kSamples) * sum * std::polar(1.0, -w * kFirstSample) *
                        power_integral({-0.5, w}, orders[static_cast<std::size_t>(term)]);
    }
  }
  return series;
}

}  // namespace

double HankelTable::sample_point(Index i) {
  return std::exp(kFirstSample + kPeriod / static_cast<double>(kSamples) * static_cast<double>(i));
}

HankelTable::HankelTable(const std::array<int, 4>& orders, const Eigen::ArrayX4d& samples)
    : coefficients_(Eigen::Array4Xd::Zero(4, (kHalfOctaves + 1) * kCoefficients)),
      begin_(kHalfOctaves + 2),
      over_half_width_(kHalfOctaves + 1) {
  const Eigen::Array4Xcd series = series_of(orders, samples);
  constexpr auto n = static_cast<double>(kCoefficients);
  begin_[0] = 0.0;
  for (Index interval = 0; interval <= kHalfOctaves; ++interval) {
    begin_[interval + 1] = kFirst * std::pow(2.0, 0.5 * static_cast<double>(interval));
    over_half_width_[interval] = 2.0 / (begin_[interval + 1] - begin_[interval]);
    for (Index j = 0; j < kCoefficients; ++j) {
      const double angle = kPi * (static_cast<double>(j) + 0.5) / n;
      const double r = begin_[interval] + (1.0 + std::cos(angle)) / over_half_width_[interval];
      const Complex turn = std::polar(1.0, -kFrequencyStep * std::log(r));
      Complex wave = 1.0 / std::sqrt(r);
      Values sum = Values::Zero();
      for (Index i = 0; i < kFrequencies; ++i, wave *= turn) sum += (series.col(i) * wave).real();
      for (Index k = 0; k < kCoefficients; ++k) {
        const double weight = (k == 0 ? 1.0 : 2.0) / n * std::cos(static_cast<double>(k) * angle);
        coefficients_.col(interval * kCoefficients + k) += weight * sum;
      }
    }
  }
}

HankelTable::Values HankelTable::at(double r) const {
  const double within = std::min(r, begin_[kHalfOctaves + 1]);
  Index interval = 0;
  if (within > kFirst) {
    // Two intervals for each power of two, read off the number's bits.
    const auto bits = std::bit_cast<std::uint64_t>(within / kFirst);
    const double mantissa = std::bit_cast<double>((bits & 0xFFFFFFFFFFFFFU) | 0x3FF0000000000000U);
    interval = 2 * (static_cast<Index>(bits >> 52U) - 1023) + (mantissa < std::numbers::sqrt2 ? 1 : 2);
    interval = std::min(interval, kHalfOctaves);
  }
  // Two chains of Chebyshev polynomials, of even and odd degree: T(k + 2) = 2 T(2) T(k) - T(k - 2).
  const double z = (within - begin_[interval]) * over_half_width_[interval] - 1.0;
  const double step = 4.0 * z * z - 2.0;
  double even = 1.0, before_even = 0.5 * step, odd = z, before_odd = z;
  Values sum = Values::Zero();
  for (Index i = interval * kCoefficients; i < (interval + 1) * kCoefficients; i += 2) {
    sum += even * coefficients_.col(i) + odd * coefficients_.col(i + 1);
    before_even = std::exchange(even, step * even - before_even);
    before_odd = std::exchange(odd, step * odd - before_odd);
  }
  return within == r ? sum : Values(sum * (within / r));
}

}  // namespace slipstick::solver
