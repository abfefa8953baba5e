#pragma once

#include <functional>
#include <vector>

#include "analytic/axisymmetric.hpp"

namespace slipstick::convergence {

// ---------------------------------------------------------------- polynomials (chebyshev.cpp)

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
  double error = 0;  ///< the largest found, relative, at points between the points of the fit

  /// Beyond either end the nearest piece is continued.
  double operator()(double x) const;
  std::size_t degree() const;  ///< the highest
};

/// The highest degree of a piece.
inline constexpr std::size_t kMaxDegree = 15;

/// Fits f between the first and the last knot, with a piece's end at each knot and at halves between them
/// where the tolerance needs it; relative errors found are at most half the tolerance. Throws
/// std::domain_error where 200 pieces do not reach it.
PiecewiseChebyshev fit_chebyshev(const std::function<double(double)>& f, const std::vector<double>& knots,
                                 double tolerance);

// ---------------------------------------------------------------- the law (twist_law.cpp)

/// Moment and rotation of an axisymmetric contact in torsion, as polynomials with a stated error.
/// Dimensionless as analytic/torsion.hpp: the rotation as t = G a^2 phi/(mu W), the moment as m = M/M_lim.
/// Near the limit t grows like the logarithm of 1 - m; in l = -ln(1 - m) both ways are smooth from rest to
/// limit: l/t is fitted over t, and t/l over l.
///
/// Relative errors of m and t are at most `error`, plus the effect of an ulp of the argument, where 1 - m is
/// at least kLastDeficit; a larger rotation carries the limit moment. A cycle between m and -m loses the
/// energy 4 M phi(m) times (l - l_1)^p times a polynomial, l_1 where slip begins and p the power of the
/// smallest losses: relative errors are at most `error` however little is lost (a sphere loses M^3, p = 1).
/// After a reversal Masing's rule gives the moment, with errors up to three times that of first loading.
struct TwistLaw {
  double moment_limit;           ///< M_lim/(mu W a)
  double full_stick;             ///< m up to which nothing slips: the law is linear there
  double error;                  ///< stated
  double last_twist;             ///< t where 1 - m is kLastDeficit
  PiecewiseChebyshev logarithm;  ///< l/t over t
  PiecewiseChebyshev twist;      ///< t/l over l
  double first_logarithm;        ///< l where slip begins
  double loss_power;
  PiecewiseChebyshev loss_factor;  ///< of (l - first_logarithm)^loss_power, over l

  double moment_ratio_at(double twist) const;  ///< m; any finite t
};

/// dM/dphi over G a^3 while everything sticks: exact, and the same for each profile.
inline constexpr double kStiffness = 16.0 / 3.0;

/// 1 - m where the fit ends.
inline constexpr double kLastDeficit = 1e-12;

/// The allowed errors.
inline constexpr double kMinLawError = 1e-11;
inline constexpr double kMaxLawError = 1e-2;

/// Throws std::domain_error for an error out of range, or that the profile does not let polynomials reach.
TwistLaw fit_twist_law(const analytic::Profile& profile, double error);

}  // namespace slipstick::convergence
