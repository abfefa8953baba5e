#pragma once

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
