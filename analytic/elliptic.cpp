#include "analytic/elliptic.hpp"

#include <fmt/core.h>
#include <gsl/gsl_sf_ellint.h>

#include <cmath>
#include <stdexcept>

#include "analytic/elliptic_series.hpp"
#include "analytic/gsl.hpp"

namespace slipstick::analytic {

namespace {

/// The series are used up to this k', where the powers of k'^2 left out are below 1e-17 of the sum.
constexpr double kLogarithmic = 0.25;
constexpr std::size_t kLogarithmicTerms = 16;

CompleteElliptic by_series(double kp) {
  static constexpr auto kLogK = series::rounded(series::logarithmic_k().log);
  static constexpr auto kConstantK = series::rounded(series::logarithmic_k().constant);
  static constexpr auto kLogE = series::rounded(series::logarithmic_e().log);
  static constexpr auto kConstantE = series::rounded(series::logarithmic_e().constant);
  const double x = kp * kp;
  const auto sum = [&](const series::Table& log, const series::Table& constant) {
    return -std::log(kp) * series::sum(log, x, kLogarithmicTerms) + series::sum(constant, x, kLogarithmicTerms);
  };
  const double k = sum(kLogK, kConstantK);
  const double e = sum(kLogE, kConstantE);
  return {.k = k, .e = e, .d = (k - e) / ((1 - kp) * (1 + kp))};
}

constexpr double kConverged = 1e-8;  // of two means; the next step squares it

/// K = pi/(2 agm(1, k')), and K - E is K/2 times the sum of 2^n c_n^2, where c_0 = k and
/// c_(n+1) = c_n^2/(4 a_(n+1)): nothing cancels in D, and little in E for k' > 1/4.
CompleteElliptic by_mean(double kp) {
  const double k2 = (1 - kp) * (1 + kp);
  double a = (1 + kp) / 2;
  double g = std::sqrt(kp);
  double term = (1 - kp) / (4 * (1 + kp));  // c_n^2/k^2
  double power = 2;
  double sum = 1 + power * term;
  for (bool last = false; !last;) {
    last = a - g <= kConverged * a;
    const double mean = (a + g) / 2;
    g = std::sqrt(a * g);
    a = mean;
    term *= term * k2 / (16 * a * a);
    power *= 2;
    sum += power * term;
  }
  const double k = std::numbers::pi / (2 * a);
  const double d = k / 2 * sum;
  return {.k = k, .e = k - k2 * d, .d = d};
}

}  // namespace

CompleteElliptic complete_elliptic(double complementary_modulus) {
  const double kp = complementary_modulus;
  if (!(kp > 0 && kp <= 1))
    throw std::domain_error(fmt::format("complementary modulus k' = {}; allowed: 0 < k' <= 1", kp));
  return kp <= kLogarithmic ? by_series(kp) : by_mean(kp);
}

double carlson_rf(double x, double y, double z) { return gsl::evaluate(gsl_sf_ellint_RF_e, x, y, z); }

double carlson_rd(double x, double y, double z) { return gsl::evaluate(gsl_sf_ellint_RD_e, x, y, z); }

double carlson_rj(double x, double y, double z, double p) { return gsl::evaluate(gsl_sf_ellint_RJ_e, x, y, z, p); }

}  // namespace slipstick::analytic
