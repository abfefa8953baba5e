#pragma once

#include <memory>

#include "analytic/axisymmetric.hpp"

/// Contacts whose friction does not follow the pressure: profiles of the bound f(r) that the shear traction
/// meets in the slip ring, instead of mu p. Torsion depends on the friction law only through this bound.
/// `pressure()` is the bound over its p0, and W is the integral of the bound over the contact, divided by mu.
///
/// A bound that falls outwards is a sum of constant bounds on discs of all radii rho: f(r) = integral of dv over the
/// bounds v < f(r), each with the disc rho(v) on which f is larger. A constant bound on a disc has closed forms, by
/// -H'(s) = v/(s sqrt(1 - (s/rho)^2)) from Abel's integral, and each is positive: sums of them cancel nowhere.
namespace slipstick::analytic {

/// A constant bound p0 (Tresca's law): H = arcosh(1/c), M/M_lim = (2/pi)(arccos c + c sqrt(1 - c^2)), stick
/// traction (2/pi) arctan(r sqrt(1 - c^2)/sqrt(c^2 - r^2)). Under any torsion a ring slips, since full stick
/// has no finite traction at the edge; for M -> 0 it is 1 - c ~ (pi M/M_lim)^2/32 wide.
const Profile& constant_bound_profile();

/// Under Hertz's pressure p0 sqrt(1 - r^2): mu p, and no more than `cap` times its peak, in (0, 1].
/// Relative error at most 20 eps. Throws std::domain_error outside the range.
std::unique_ptr<const Profile> capped_hertz_profile(double cap);

/// Under Hertz's pressure: k p^n, n in (0, 3]; p0 is the bound at the centre. Relative error at most 20 eps.
/// Throws std::domain_error outside the range.
std::unique_ptr<const Profile> power_of_hertz_profile(double exponent);

}  // namespace slipstick::analytic
