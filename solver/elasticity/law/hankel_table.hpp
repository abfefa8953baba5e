#pragma once

#include <array>
#include <functional>
#include <vector>

#include "solver/grid/grid.hpp"

namespace slipstick::solver {

/// Integrals over all x > 0 of s(x) J_m(x r) for several functions s, each with its own order m of Bessel's
/// function, tabulated for r > 0. s is bounded, analytic in a sector around the positive axis, and decays
/// like exp(-2 x). The error is below 5e-13/(1 + r) up to r = 1e7, times the largest s; beyond, an integral
/// is taken to fall like 1/r.
class HankelTable {
 public:
  static constexpr std::size_t kTerms = 4;
  using Values = std::array<double, kTerms>;

  /// spectrum: all s at one x.
  HankelTable(const std::array<int, kTerms>& orders, const std::function<Values(double x)>& spectrum);

  /// Where an r lies.
  struct Place {
    const double* coefficients;  ///< of the interval's first term
    double z;                    ///< in [-1, 1], within the interval
    double scale;                ///< 1; beyond the last interval what 1/r has fallen by
  };
  Place place(double r) const;

  /// A term's integral: Clenshaw's sum of its Chebyshev polynomials.
  static double value(const Place& place, std::size_t term) {
    const double* const c = place.coefficients + term * kCoefficients;
    double b = 0.0;
    double before = 0.0;
    for (std::size_t i = kCoefficients - 1; i > 0; --i) {
      const double next = 2.0 * place.z * b - before + c[i];
      before = b;
      b = next;
    }
    return place.scale * (place.z * b - before + c[0]);
  }

 private:
  /// An integral is analytic but at r = 0, where s is not known, and at r = +-2 i. So polynomials of degree
  /// 13 leave less than 12^-14 on an interval from a to sqrt(2) a, and on the first one, from 0 to 1/2.
  static constexpr std::size_t kCoefficients = 14;

  std::vector<double> coefficients_;  ///< interval by interval, term by term
  std::vector<double> middle_, half_width_;
};

}  // namespace slipstick::solver
