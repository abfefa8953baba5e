#pragma once

#include <Eigen/Core>
#include <array>

#include "solver/grid/grid.hpp"

namespace slipstick::solver {

/// Integrals over all x > 0 of s(x) J_m(x r) for four functions s, each with its own order m of Bessel's
/// function, tabulated for r >= 0. s is bounded, analytic in a sector around the positive axis, and decays
/// like exp(-2 x). The error is below 5e-13/(1 + r) times the largest s up to r = 1e7; beyond, an integral
/// is assumed to fall like 1/r.
///
/// 1. sqrt(x) s(x) as a Fourier series in ln x, by FFT.
/// 2. Each term x^(-1/2 + i w) has its integral in closed form, so that the series can be summed at any r.
/// 3. Chebyshev polynomials of the sums on intervals of r.
class HankelTable {
 public:
  using Values = Eigen::Array4d;

  static constexpr Index kSamples = 2048;
  static double sample_point(Index i);

  /// Row i of samples: all s at sample_point(i).
  HankelTable(const std::array<int, 4>& orders, const Eigen::ArrayX4d& samples);
  /// spectrum(x): the Values of all s at x.
  template <class Spectrum>
  static HankelTable of(const std::array<int, 4>& orders, const Spectrum& spectrum) {
    Eigen::ArrayX4d samples(kSamples, 4);
    for (Index i = 0; i < kSamples; ++i) samples.row(i) = Values(spectrum(sample_point(i))).transpose();
    return {orders, samples};
  }

  Values at(double r) const;

 private:
  /// An integral is analytic but at r = 0, where s is not known, and at r = +-2 i. So polynomials of degree
  /// 13 leave less than 12^-14 on an interval from a to sqrt(2) a, and on the first one, from 0 to 1/2.
  static constexpr Index kCoefficients = 14;

  Eigen::Array4Xd coefficients_;            ///< of Chebyshev polynomials, interval by interval
  Eigen::ArrayXd begin_, over_half_width_;  ///< of the intervals
};

}  // namespace slipstick::solver
