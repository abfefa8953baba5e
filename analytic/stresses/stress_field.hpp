#pragma once

#include <vector>

#include "analytic/cycle.hpp"
#include "analytic/torsion.hpp"

/// Stresses below the surface of a half-space under an axisymmetric contact in torsion. Axes r, theta, and z
/// along the normal that points out of the body, so that sigma_tz is the traction q at the surface; the depth
/// is positive inside. Lengths over the contact radius a. Stresses by the pressure are over p0, those by the
/// torsion over mu p0; together they are the stresses of one of two bodies that torsion does not press apart
/// (similar materials, or a friction so small that the pressure does not feel the torsion).
namespace slipstick::analytic {

/// A point of the body, over a.
struct BodyPoint {
  double radius;
  double depth;
};

/// Stresses by the pressure; NaN where the pressure is not known (under a constant bound).
struct PressureStress {
  double rr;
  double tt;
  double zz;
  double rz;
};

/// Stresses by the torsion.
struct TorsionStress {
  double rt;
  double tz;
};

/// Numbers that criteria of yield and fracture compare with a strength, over p0.
struct Severity {
  double von_mises;  ///< equivalent tensile stress
  double tresca;     ///< largest less smallest principal stress
  double tension;    ///< largest principal stress; negative: all are compressive
};
Severity severity(const PressureStress& pressure, const TorsionStress& torsion, double friction);

/// The stresses of one state. Error at most 1e-12 of the largest stress, for tables of more than 257 points
/// 1e-7. The profile must outlive the field.
///
/// Every stress is an integral over rigid flat discs of radii s (torsion: Reissner and Sagoci 1944, pressure:
/// Boussinesq, Sneddon 1965), whose stresses are elementary functions of R = sqrt(r^2 + (z + i s)^2); Hertz's
/// pressure (Huber 1904) has that integral in closed form.
class StressField {
 public:
  /// First loading.
  StressField(const TorsionState& state, const Profile& profile);
  /// A history: the sum of its branches (Masing's rule).
  StressField(const LoadingHistory& history, const Profile& profile);

  /// Throw std::domain_error for points outside the body, and where the stress is infinite.
  PressureStress by_pressure(BodyPoint point, double poisson) const;
  TorsionStress by_torsion(BodyPoint point) const;
  const Profile& profile() const { return *profile_; }

 private:
  struct Part {
    double weight;
    TorsionState state;
  };
  const Profile* profile_;
  std::vector<Part> parts_;
};

}  // namespace slipstick::analytic
