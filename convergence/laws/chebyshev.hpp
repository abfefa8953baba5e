#pragma once

#include <functional>
#include <vector>

namespace slipstick::convergence {

/// A polynomial on an interval, as coefficients of the Chebyshev polynomials of x scaled to [-1, 1].
struct ChebyshevPiece {
  double low;
  double high;
  std::vector<double> coefficients;

  double operator()(double x) const;
};

/// A function as polynomials on intervals that follow each other.
struct PiecewiseChebyshev {
  std::vector<ChebyshevPiece> pieces;
  double error = 0;  ///< the largest found, relative, at points between those of the fit

  /// Beyond either end the nearest piece goes on.
  double operator()(double x) const;
  std::size_t degree() const;  ///< the highest
};

/// The highest degree of a piece.
inline constexpr std::size_t kMaxDegree = 15;

/// Fits f between the first and the last knot, with a piece's end at each knot and at halves between them
/// where the tolerance asks for it; relative errors found are at most half the tolerance. Throws
/// std::domain_error where 200 pieces do not reach it.
PiecewiseChebyshev fit_chebyshev(const std::function<double(double)>& f, const std::vector<double>& knots,
                                 double tolerance);

}  // namespace slipstick::convergence
