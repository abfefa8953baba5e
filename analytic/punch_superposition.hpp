#pragma once

#include <memory>

#include "analytic/axisymmetric.hpp"

/// Pressures made of flat punches' pressures of all radii x, p(r) = integral_r^1 w(x)/sqrt(x^2 - r^2) dx with
/// w >= 0: as for every convex indenter. The contributions of a flat punch of radius x to H, to the moment
/// and to a traction are positive, so that integrals over w do not cancel. Relative error at most 10 eps (of
/// twist_slope 20) for c in [1e-12, 1 - 1e-12], and no failure for c or 1 - c down to 1e-100.
namespace slipstick::analytic {

/// Indenter whose gap grows like r^n, n in [0.01, 1000]: w = x^(n-1). n = 2 is the sphere, with p0 the peak;
/// n = 1 the cone, with p0 the mean; in general the mean is 2 p0/(n + 1).
///
/// The ends. r -> 0: the peak is p0/(n - 1); for n <= 1 it is infinite, p grows like r^(n-1) (n = 1: ln 1/r),
/// and so does a traction with c -> 0. c -> 0: 1 - M/M_lim goes like c^3 for n > 1, c^3 ln(1/c) for n = 1,
/// c^(n+2) for n < 1. c -> 1: M/M_lim goes like 1 - c. Throws std::domain_error outside the range of n.
std::unique_ptr<const Profile> power_profile(double exponent);

/// Flat punch out to b = flat_ratio in [0, 1), with rounded corners: gap (r - b)^2/(2 R) beyond (Ciavarella 1999). w ~
/// 2 sqrt(x^2 - b^2) - b arccos(b/x) for x > b, none below; p0 is the mean pressure W/(pi a^2). b = 0 is a sphere.
///
/// The ends. c < b: 1 - M/M_lim goes like c^3, as under every finite pressure. c -> 1: M/M_lim goes like 1 -
/// c however small 1 - b, since p ends at zero; but it is small only for 1 - c below 1 - b, and at c = b it
/// comes near the flat punch's share at full stick, 8/(3 pi), as b -> 1.
/// Throws std::domain_error outside the range of b.
std::unique_ptr<const Profile> rounded_punch_profile(double flat_ratio);

}  // namespace slipstick::analytic
