#include "solver/elasticity/law/hankel_table.hpp"

#include <gsl/gsl_fft_real.h>
#include <gsl/gsl_sf_gamma.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <numeric>

namespace slipstick::solver {
namespace {

using Complex = std::complex<double>;
constexpr double kPi = std::numbers::pi;

/// s(x) sqrt(x) is a function of ln x, sampled over one period. It falls to rounding at both ends: like
/// exp(-2 x) above, like sqrt(x) below, with room for what a large r asks for, kOctaves of them.
constexpr std::size_t kSamples = 2048;
constexpr double kLargest = 25.0;
constexpr double kPeriod = 112.0;
/// Frequencies above are below rounding, where s is analytic 45 degrees off the axis.
constexpr double kLargestFrequency = 45.0;
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

/// Sums over frequencies: each term is r^(-1/2) times the real part of the sum of c exp(-i w ln r).
struct Series {
  double step = 2.0 * kPi / kPeriod;
  std::array<std::vector<Complex>, HankelTable::kTerms> c;

  HankelTable::Values at(double r) const {
    HankelTable::Values sum{};
    const Complex turn = std::polar(1.0, -step * std::log(r));
    Complex wave = 1.0;
    for (std::size_t n = 0; n < c.front().size(); ++n, wave *= turn) {
      for (std::size_t term = 0; term < sum.size(); ++term) sum[term] += (c[term][n] * wave).real();
    }
    for (double& value : sum) value /= std::sqrt(r);
    return sum;
  }
};

/// The powers x^(-1/2 + i w) that make up each s have integrals in closed form.
Series series_of(const std::array<int, HankelTable::kTerms>& orders,
                 const std::function<HankelTable::Values(double)>& spectrum) {
  const double first = std::log(kLargest) - kPeriod;
  std::array<std::vector<double>, HankelTable::kTerms> samples;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const double x = std::exp(first + kPeriod * static_cast<double>(i) / static_cast<double>(kSamples));
    const HankelTable::Values s = spectrum(x);
    for (std::size_t term = 0; term < s.size(); ++term) samples[term].push_back(s[term] * std::sqrt(x));
  }
  Series series;
  const auto frequencies = static_cast<std::size_t>(kLargestFrequency / series.step);
  for (std::size_t term = 0; term < samples.size(); ++term) {
    double* const a = samples[term].data();
    gsl_fft_real_radix2_transform(a, 1, kSamples);
    for (std::size_t n = 0; n < frequencies; ++n) {
      const double w = series.step * static_cast<double>(n);
      const Complex sum(a[n], n == 0 ? 0.0 : a[kSamples - n]);
      series.c[term].push_back((n == 0 ? 1.0 : 2.0) / static_cast<double>(kSamples) * sum *
                               std::polar(1.0, -w * first) * power_integral({-0.5, w}, orders[term]));
    }
  }
  return series;
}

/// Values at Chebyshev's nodes in [-1, 1] to Chebyshev's coefficients, which fall fast, and these to those of
/// powers: at once, the first would lose what the second gains.
template <std::size_t n>
struct Interpolation {
  using Row = std::array<double, n>;
  Row node{};
  std::array<Row, n> weight{};      ///< of each value in each of Chebyshev's coefficients
  std::array<Row, n> polynomial{};  ///< Chebyshev's, lowest power first

  Interpolation() {
    for (std::size_t k = 0; k < n; ++k) {
      const double factor = k == 0 ? 1.0 : 2.0;
      for (std::size_t j = 0; j < n; ++j) {
        const double angle = kPi * (static_cast<double>(j) + 0.5) / static_cast<double>(n);
        node[j] = std::cos(angle);
        weight[k][j] = factor / static_cast<double>(n) * std::cos(static_cast<double>(k) * angle);
      }
    }
    polynomial[0][0] = polynomial[1][1] = 1.0;
    for (std::size_t k = 2; k < n; ++k) {
      for (std::size_t i = 0; i < n; ++i) {
        polynomial[k][i] = (i == 0 ? 0.0 : 2.0 * polynomial[k - 1][i - 1]) - polynomial[k - 2][i];
      }
    }
  }

  Row powers(const Row& values) const {
    Row sum{};
    for (std::size_t k = 0; k < n; ++k) {
      const double c = std::inner_product(values.begin(), values.end(), weight[k].begin(), 0.0);
      for (std::size_t i = 0; i < n; ++i) sum[i] += c * polynomial[k][i];
    }
    return sum;
  }
};

}  // namespace

HankelTable::HankelTable(const std::array<int, kTerms>& orders,
                         const std::function<Values(double x)>& spectrum) {
  static const Interpolation<kCoefficients> interpolation;
  const Series series = series_of(orders, spectrum);
  for (Index interval = 0; interval <= kHalfOctaves; ++interval) {
    const double end = kFirst * std::pow(2.0, 0.5 * static_cast<double>(interval));
    const double begin = interval == 0 ? 0.0 : end / std::numbers::sqrt2;
    middle_.push_back(0.5 * (begin + end));
    over_half_width_.push_back(2.0 / (end - begin));
    std::array<std::array<double, kCoefficients>, kTerms> values;
    for (std::size_t j = 0; j < kCoefficients; ++j) {
      const Values at_node = series.at(middle_.back() + interpolation.node[j] / over_half_width_.back());
      for (std::size_t term = 0; term < kTerms; ++term) values[term][j] = at_node[term];
    }
    for (const auto& of_term : values) {
      const auto powers = interpolation.powers(of_term);
      coefficients_.insert(coefficients_.end(), powers.begin(), powers.end());
    }
  }
}

HankelTable::Place HankelTable::place(double r) const {
  Index interval = 0;
  double scale = 1.0;
  if (r > kFirst) {
    // Exponent and mantissa of the ratio.
    const auto bits = std::bit_cast<std::uint64_t>(r / kFirst);
    const auto exponent = static_cast<Index>(bits >> 52U) - 1023;
    const double mantissa = std::bit_cast<double>((bits & 0xFFFFFFFFFFFFFU) | 0x3FF0000000000000U);
    interval = 2 * exponent + (mantissa < std::numbers::sqrt2 ? 1 : 2);
    if (interval > kHalfOctaves) {
      interval = kHalfOctaves;
      const double end = middle_.back() + 1.0 / over_half_width_.back();
      scale = end / r;
      r = end;
    }
  }
  const auto i = static_cast<std::size_t>(interval);
  return {coefficients_.data() + interval * kTerms * kCoefficients, (r - middle_[i]) * over_half_width_[i],
          scale};
}

}  // namespace slipstick::solver
