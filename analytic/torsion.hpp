#pragma once

namespace slipstick::analytic {

/// One state of a sphere in torsion on a half-space with a slip ring a_s < r < a (Lubkin 1951).
/// Dimensionless: lengths over the contact radius a, moments over mu W a, twist as G a^2 phi/(mu W), with the
/// combined modulus 1/G = 1/G_1 + 1/G_2. Both a number and its complement are carried, so that neither end of
/// the range loses digits.
struct TorsionState {
  double moment_ratio;       ///< M/M_lim
  double moment_deficit;     ///< 1 - M/M_lim
  double stick_ratio;        ///< c = a_s/a, the paper's k*
  double stick_complement;   ///< 1 - c
  double twist;              ///< G a^2 phi/(mu W), Eq. (4)
  double moment;             ///< M/(mu W a), Eq. (5)
  double tangent_stiffness;  ///< (dM/dphi)/(G a^3) = 16/3 c^3
};

/// M_lim/(mu W a) = 3 pi/16, Eq. (6).
double moment_limit();

/// The state at a given load, stick radius or twist. Relative error of every member about 1e-15, plus what an
/// ulp or two of the argument cost; the deficit and the stiffness underflow below c = 1e-103. Each throws
/// std::domain_error, with the value and the range, outside moment_ratio in [0, 1), moment_deficit in (0, 1],
/// stick_ratio in (0, 1], stick_complement in [0, 1), twist in [0, 169] (beyond, the stick ratio underflows).
TorsionState from_moment_ratio(double moment_ratio);
TorsionState from_moment_deficit(double moment_deficit);
TorsionState from_stick_ratio(double stick_ratio);
TorsionState from_stick_complement(double stick_complement);
TorsionState from_twist(double twist);

/// Circumferential shear traction q/(mu p0) at radius r/a in [0, 1], Eq. (1) with its factor mended; free of
/// cancellation (a single R_J in the stick zone). Throws std::domain_error outside [0, 1].
double traction(const TorsionState& state, double radius);

}  // namespace slipstick::analytic
