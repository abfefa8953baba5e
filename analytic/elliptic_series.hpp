#pragma once

#include <array>
#include <cstddef>
#include <numbers>

/// Power series of the complete elliptic integrals K, E and B = (E - k'^2 K)/k^2 about both ends of the
/// modulus, as tables made at compile time. With y = k^2 and s = k':
///   f = f(y = 0) * sum taylor_n y^n               (DLMF 19.5.1, 19.5.2),
///   f = sum s^(2n) (log_n ln(1/s) + constant_n)   (DLMF 19.12.1, 19.12.2).
/// For y or s^2 up to 1/2, also after integration and after the products below, the terms left out are below
/// 1e-17 of the sum.
namespace slipstick::analytic::series {

constexpr std::size_t kTerms = 50;
using Exact = std::array<long double, kTerms>;  ///< while coefficients are made: no rounding is left in doubles
using Table = std::array<double, kTerms>;

constexpr Table rounded(const Exact& exact) {
  Table table{};
  for (std::size_t n = 0; n < kTerms; ++n) table[n] = static_cast<double>(exact[n]);
  return table;
}

/// Gauss's 2F1(a, b; c; y).
constexpr Exact hypergeometric(long double a, long double b, long double c) {
  Exact series{1};
  for (std::size_t n = 1; n < kTerms; ++n) {
    const auto m = static_cast<long double>(n - 1);
    series[n] = series[n - 1] * (a + m) * (b + m) / ((c + m) * (m + 1));
  }
  return series;
}

constexpr Exact product(const Exact& f, const Exact& g) {
  Exact series{};
  for (std::size_t n = 0; n < kTerms; ++n)
    for (std::size_t j = 0; j <= n; ++j) series[n] += f[j] * g[n - j];
  return series;
}

/// f/(1 - y).
constexpr Exact summed(const Exact& f) {
  Exact series = f;
  for (std::size_t n = 1; n < kTerms; ++n) series[n] += series[n - 1];
  return series;
}

/// sqrt(1 - y), which is s.
constexpr Exact complementary_modulus() { return hypergeometric(-0.5L, 1, 1); }
constexpr Exact taylor_k() { return hypergeometric(0.5L, 0.5L, 1); }
constexpr Exact taylor_e() { return hypergeometric(-0.5L, 0.5L, 1); }
constexpr Exact taylor_b() { return hypergeometric(0.5L, 0.5L, 2); }

struct Logarithmic {
  Exact log;
  Exact constant;
};

/// d(n) of DLMF 19.12: d(0) = 2 ln 2, d(n + 1) = d(n) - 2/((2n + 1)(2n + 2)).
constexpr Exact logarithmic_shift() {
  Exact d{2 * std::numbers::ln2_v<long double>};
  for (std::size_t n = 1; n < kTerms; ++n) d[n] = d[n - 1] - 2.0L / static_cast<long double>((2 * n - 1) * (2 * n));
  return d;
}

constexpr Logarithmic logarithmic_k() {
  const Exact d = logarithmic_shift();
  Logarithmic series{.log = hypergeometric(0.5L, 0.5L, 1), .constant = {}};
  for (std::size_t n = 0; n < kTerms; ++n) series.constant[n] = series.log[n] * d[n];
  return series;
}

constexpr Logarithmic logarithmic_e() {
  const Exact d = logarithmic_shift();
  const Exact coefficient = hypergeometric(0.5L, 1.5L, 2);
  Logarithmic series{.log = {0}, .constant = {1}};
  for (std::size_t n = 0; n + 1 < kTerms; ++n) {
    series.log[n + 1] = coefficient[n] / 2;
    series.constant[n + 1] = coefficient[n] / 2 * (d[n] - 1.0L / static_cast<long double>((2 * n + 1) * (2 * n + 2)));
  }
  return series;
}

constexpr Logarithmic logarithmic_b() {
  const Logarithmic k = logarithmic_k();
  Logarithmic series = logarithmic_e();
  for (std::size_t n = 1; n < kTerms; ++n) {
    series.log[n] -= k.log[n - 1];
    series.constant[n] -= k.constant[n - 1];
  }
  return {.log = summed(series.log), .constant = summed(series.constant)};
}

/// sum table_n x^n, n < terms; even and odd powers apart, so that two sums run side by side.
constexpr double sum(const Table& table, double x, std::size_t terms = kTerms) {
  const double x2 = x * x;
  double even = 0, odd = 0;
  for (std::size_t n = terms; n >= 2; n -= 2) {
    odd = table[n - 1] + x2 * odd;
    even = table[n - 2] + x2 * even;
  }
  return even + x * odd;
}

}  // namespace slipstick::analytic::series
