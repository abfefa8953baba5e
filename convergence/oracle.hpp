#pragma once

#include <optional>
#include <string>

#include "analytic/axisymmetric.hpp"
#include "analytic/torsion.hpp"
#include "solver/scene.hpp"

namespace slipstick::convergence {

/// The exact answer for an axisymmetric scene, in the scene's units (SI): the normal contact of its indenter
/// (Hertz, Love, Boussinesq) in torsion (Lubkin 1951; Jaeger 1995).
struct Oracle {
  const analytic::Profile* profile;  ///< one of the profiles that live as long as the program
  double contact_radius;             ///< m
  double reference_pressure;         ///< Pa, the profile's p0
  double peak_pressure;              ///< Pa; infinite under a cone and a flat punch
  double approach;                   ///< m
  double moment_limit;               ///< N m
  double moment;                     ///< N m
  double twist_angle;                ///< rad
  double stick_radius;               ///< m; the contact radius where everything sticks
  double friction;
  analytic::TorsionState state;

  /// Pressure and circumferential traction at a distance from the axis in m; zero outside the contact. A
  /// cone's pressure is infinite on the axis; no traction is.
  double pressure(double radius) const;
  double traction(double radius) const;
};

/// The oracle, or why there is none. A load given as a ratio is the same ratio of the exact limit moment.
struct OracleAnswer {
  std::optional<Oracle> oracle;
  std::string reason;
  bool out_of_range = false;  ///< there is an exact solution, but not at this load: gross slip, or nearly
};
OracleAnswer find_oracle(const solver::Scene& scene);

}  // namespace slipstick::convergence
