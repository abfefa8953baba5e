#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "solver/grid/grid.hpp"

namespace slipstick::solver {

/// Integrals over all x > 0 of s(x) J_m(x r) for several functions s, each with its own order m of Bessel's
/// function, tabulated for r > 0. s is bounded, analytic in a sector around the positive axis, and decays
/// like exp(-2 x). x and r have no units. The error is below 5e-13/(1 + r) up to r = 1e7, times the largest
/// s; beyond, an integral is taken to fall like 1/r.
class HankelTable {
 public:
  static constexpr Index kTerms = 4;
  using Values = std::array<double, kTerms>;

  /// spectrum: all s at one x.
  HankelTable(const std::array<int, kTerms>& orders, const std::function<Values(double x)>& spectrum);

  /// The polynomial that holds at r.
  struct Place {
    const double* coefficients;  ///< of the first term
    double z;                    ///< in [-1, 1]
    double scale;                ///< 1; beyond the last polynomial what 1/r has fallen by
  };
  Place place(double r) const;

  /// A term's integral.
  static double value(const Place& place, Index term) {
    const double* const c = place.coefficients + term * kCoefficients;
    double sum = c[kCoefficients - 1];
    for (Index i = kCoefficients - 2; i >= 0; --i) sum = sum * place.z + c[i];
    return place.scale * sum;
  }

 private:
  /// Polynomials of degree 13. The integrals are analytic but at r = 0, where s is not known, and at r = +-2
  /// i. So those on an interval from a to sqrt(2) a, and on one from 0 to 1/2, leave less than 12^-14.
  static constexpr Index kCoefficients = 14;

  std::vector<double> coefficients_;  ///< interval by interval, term by term, lowest power first
  std::vector<double> middle_, over_half_width_;
};

}  // namespace slipstick::solver
