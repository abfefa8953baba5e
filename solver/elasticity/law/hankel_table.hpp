#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>

#include "solver/grid/grid.hpp"

namespace slipstick::solver {

/// Integrals over all x > 0 of s(x) J_m(x r) for four functions s, each with its own order m of Bessel's
/// function, tabulated for r >= 0. s is bounded, analytic in a sector around the positive axis, and decays
/// like exp(-2 x). The error is below 5e-13/(1 + r) up to r = 1e7, times the largest s; beyond, an integral
/// is taken to fall like 1/r.
class HankelTable {
 public:
  using Values = Eigen::Array4d;

  /// spectrum: all s at one x.
  HankelTable(const std::array<int, 4>& orders, const std::function<Values(double x)>& spectrum);

  Values at(double r) const;

 private:
  /// An integral is analytic but at r = 0, where s is not known, and at r = +-2 i. So polynomials of degree
  /// 13 leave less than 12^-14 on an interval from a to sqrt(2) a, and on the first one, from 0 to 1/2.
  static constexpr Index kCoefficients = 14;

  Eigen::Array4Xd coefficients_;            ///< of Chebyshev polynomials, interval by interval
  Eigen::ArrayXd begin_, over_half_width_;  ///< of the intervals
};

}  // namespace slipstick::solver
