#pragma once

#include <memory>
#include <string>

#include "analytic/axisymmetric.hpp"
#include "analytic/layered/fredholm.hpp"

namespace slipstick::analytic::layered {

/// p(r) = edge/sqrt(1 - r^2) + integral_r^1 x w(x^2)/sqrt(x^2 - r^2) dx, r over the contact radius: Hertz's
/// pressure over its peak has w = 1, a flat punch's over that at its centre edge = 1.
struct Pressure {
  std::string name;  ///< of the profile
  std::string unit;  ///< p0 in words
  PiecewisePolynomial weight;
  double edge;
};

/// Torsion of coated bodies under an axisymmetric pressure, as a Profile: torsion.hpp and cycle.hpp hold for
/// it unchanged, with G of the surface materials. Its H(c) is 2 G phi/mu, its stiffness the stiffness of a
/// bonded punch of radius c on the coated bodies. With q(r) = -d/dr integral_r^1 chi(t)/sqrt(t^2 - r^2) dt
/// the ring that slips has chi = (2/pi) mu t H(t) of the pressure's own H, whatever lies below; within c
///   chi(t) + integral_0^1 K(t, s) chi(s) ds = (4 G phi/pi) t,  chi continuous at c,
/// a Fredholm equation of the second kind. M = 4 pi integral t chi dt.
///
/// torsion: the transform of the torsional excess, lengths over the contact radius, reach 2. The profile
/// caches the last stick radii; several threads may use it.
std::unique_ptr<const Profile> layered_profile(const Pressure& pressure, const CosineTransform& torsion);

}  // namespace slipstick::analytic::layered
