#pragma once

#include "analytic/axisymmetric.hpp"

namespace slipstick::analytic {

/// One state of an axisymmetric contact in torsion with a slip ring a_s < r < a (sphere: Lubkin 1951). Dimensionless:
/// lengths over the contact radius a, moments over mu W a, twist as G a^2 phi/(mu W), with the combined modulus 1/G =
/// 1/G_1 + 1/G_2. Both a number and its complement are carried, so that neither end of the range loses digits.
struct TorsionState {
  double moment_ratio;       ///< M/M_lim
  double moment_deficit;     ///< 1 - M/M_lim
  double stick_ratio;        ///< c = a_s/a, the paper's k*
  double stick_complement;   ///< 1 - c
  double twist;              ///< G a^2 phi/(mu W), Eq. (4)
  double moment;             ///< M/(mu W a), Eq. (5)
  double tangent_stiffness;  ///< (dM/dphi)/(G a^3); of half-spaces 16/3 c^3
};

/// The state at a given load, stick radius or twist. Relative error of every member at most 8 eps for sphere,
/// cone and flat punch, or 4 times what an ulp of the argument costs where that is more. Each throws
/// std::domain_error, with the value and the range, outside moment_ratio 0 or in [2.3e-308, 1),
/// moment_deficit in [2.3e-308, 1], stick_ratio in [2.3e-308, 1], stick_complement in [0, 1), and for a twist
/// below 0 or so large that the stick ratio underflows (sphere: 169). The deficit and the stiffness lose
/// digits and underflow below c = 1e-102. A flat punch sticks everywhere up to full_stick(): its stick ratio
/// is 1 at every load up to that one, and a stick ratio of 1 names the last of them.
TorsionState from_moment_ratio(double moment_ratio, const Profile& profile = hertz_profile());
TorsionState from_moment_deficit(double moment_deficit, const Profile& profile = hertz_profile());
TorsionState from_stick_ratio(double stick_ratio, const Profile& profile = hertz_profile());
TorsionState from_stick_complement(double stick_complement, const Profile& profile = hertz_profile());
TorsionState from_twist(double twist, const Profile& profile = hertz_profile());

/// Circumferential shear traction q/(mu p0) at radius r/a in [0, 1], Eq. (1) with its factor corrected; free of
/// cancellation. Throws std::domain_error outside [0, 1], and where it is infinite (at the edge of a flat punch).
double traction(const TorsionState& state, double radius, const Profile& profile = hertz_profile());

}  // namespace slipstick::analytic
