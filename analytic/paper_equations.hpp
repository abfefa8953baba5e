#pragma once

#include <span>

/// The paper's Eqs. (1) and (4)-(7) one by one, with (2) and (3) inside them, as printed and, where the print
/// is wrong, as they should be. (Gradinaru and Spinu, Numerical simulation of elastic torsional contact with
/// slip and stick.) They serve comparison; compute with torsion.hpp. All dimensionless as there, each
/// evaluated as printed, cancellation included. Each throws std::domain_error outside the range given.
namespace slipstick::analytic::paper {

/// Eq. (1) as printed, q/(mu p0): its stick branch is pi/2 too large. r in [0, 1], c in (0, 1).
double eq1_printed(double stick_ratio, double radius);
/// Eq. (1) with the missing factor 2/pi, evaluated literally (with its cancellation near r = 0).
double eq1(double stick_ratio, double radius);
/// Eq. (4): twist G a^2 phi/(mu W), c in (0, 1); good to 1e-14 between 0.01 and 0.99.
double eq4_twist(double stick_ratio);
/// Eq. (5): M/(mu W a), c in (0, 1), its two integrals by adaptive quadrature. Right as printed, but its
/// terms cancel as c -> 1: the relative error is 1e-14 at 0.99, 5e-12 at 0.999, 3e-6 at 0.999999.
double eq5_moment(double stick_ratio);
/// Eq. (6): M_lim/(mu W a).
double eq6_moment_limit();
/// Eq. (7): twist from the moment M/(mu W a), printed as an equality, in truth for small moments only.
/// moment in [0, 2/3].
double eq7_twist(double moment);

}  // namespace slipstick::analytic::paper

/// Laws in use for the twist of a sphere, as functions of the moment M/(mu W a); twist as G a^2 phi/(mu W).
/// These are for comparison: torsion.hpp has the exact law, twist unbounded as M tends to 3 pi/16 = 0.589.
/// Each throws std::domain_error outside the range given and for NaN.
///
/// Errors at M/M_lim                    0.1       0.5       0.9
///   no_slip_twist, dem_twist         -4.5 %   -25.1 %   -56.4 %
///   small_moment_twist              -0.29 %    -8.5 %   -39.1 %
///   paper::eq7_twist               -0.093 %    -3.4 %   -23.6 %
///   dem_moment at the exact twist    +4.7 %   +33.5 %   +25.8 %, the worst +62 % at twist 1/8
namespace slipstick::analytic {

/// (3/16) M: no slip anywhere (Reissner and Sagoci 1944), the tangent at M = 0. moment in [0, 3 pi/16].
double no_slip_twist(double moment);

/// (3/16) M + (9/64) M^2: the exact law to second order, by expansion of moment and twist in 1 - a_s/a; Eq.
/// (7) has the same two terms. moment in [0, 3 pi/16].
double small_moment_twist(double moment);

/// Discrete element codes: a linear spring, and free spinning at (2/3) mu W a, as if the pressure were uniform
/// (Marshall 2009): 13 % more than the sphere can carry. All these codes have this cap. Their springs differ
/// (Marshall's is half the tangential stiffness times a^2); this one has the stiffness without slip, (16/3) G a^3.
double dem_moment_limit();
/// min((16/3) twist, 2/3). twist >= 0.
double dem_moment(double twist);
/// Its inverse below the cap: (3/16) M. moment in [0, 2/3].
double dem_twist(double moment);

/// A law by name; the key is for files.
struct Approximation {
  const char* key;
  const char* name;
  double (*twist)(double moment);  ///< of M/(mu W a) in [0, 3 pi/16] at least
};

/// All of them, Eq. (7) included.
std::span<const Approximation> approximations();

}  // namespace slipstick::analytic
