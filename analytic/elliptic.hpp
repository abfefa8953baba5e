#pragma once

namespace slipstick::analytic {

/// Complete elliptic integrals, and D = (K - E)/k^2 as in the paper's Eq. (3).
struct CompleteElliptic {
  double k;
  double e;
  double d;
};

/// Complete elliptic integrals of modulus k = sqrt(1 - k'^2), given the complementary modulus k' in (0, 1]:
/// by the arithmetic-geometric mean, near k' = 0 by logarithmic series (DLMF 19.8, 19.12). Relative error at
/// most 5 eps, where forms in k lose everything at either end.
/// Throws std::domain_error for k' outside (0, 1] or NaN.
CompleteElliptic complete_elliptic(double complementary_modulus);

/// Carlson's symmetric integrals R_F(x, y, z), R_D(x, y, z), R_J(x, y, z, p) (DLMF 19.16).
/// Throw std::domain_error where GSL refuses: arguments below about 1e-205 (R_D) or 1e-103 (R_J) included.
double carlson_rf(double x, double y, double z);
double carlson_rd(double x, double y, double z);
double carlson_rj(double x, double y, double z, double p);

}  // namespace slipstick::analytic
