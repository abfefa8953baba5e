#include "analytic/elliptic.hpp"

#include <fmt/core.h>
#include <gsl/gsl_sf_ellint.h>

#include <cmath>
#include <stdexcept>

#include "analytic/gsl.hpp"

namespace slipstick::analytic {

CompleteElliptic complete_elliptic(double complementary_modulus) {
  // Below this the next terms of the expansion at k' = 0, k'^2 ln(1/k') (DLMF 19.12.1), are less than one
  // ulp.
  constexpr double kLogarithmic = 1e-9;

  const double kp = complementary_modulus;
  if (!(kp > 0 && kp <= 1))
    throw std::domain_error(fmt::format("complementary modulus k' = {}; allowed: 0 < k' <= 1", kp));
  if (kp < kLogarithmic) {
    const double k = 2 * std::log(2.0) - std::log(kp);
    return {.k = k, .e = 1, .d = k - 1};
  }
  const double kp2 = kp * kp;
  const double rd = carlson_rd(0, kp2, 1);
  return {.k = carlson_rf(0, kp2, 1), .e = kp2 * (rd + carlson_rd(0, 1, kp2)) / 3, .d = rd / 3};
}

double carlson_rf(double x, double y, double z) { return gsl::evaluate(gsl_sf_ellint_RF_e, x, y, z); }

double carlson_rd(double x, double y, double z) { return gsl::evaluate(gsl_sf_ellint_RD_e, x, y, z); }

double carlson_rj(double x, double y, double z, double p) {
  return gsl::evaluate(gsl_sf_ellint_RJ_e, x, y, z, p);
}

}  // namespace slipstick::analytic
