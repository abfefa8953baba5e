#pragma once

#include <optional>
#include <string>

#include "analytic/torsion.hpp"
#include "solver/scene.hpp"

namespace slipstick::convergence {

/// The exact answer for a scene, in the scene's units (SI): Hertz's contact of a sphere in torsion (Lubkin
/// 1951).
struct Oracle {
  double contact_radius;  ///< m
  double peak_pressure;   ///< Pa
  double approach;        ///< m
  double moment_limit;    ///< N m
  double moment;          ///< N m
  double twist_angle;     ///< rad
  double stick_radius;    ///< m
  double friction;
  analytic::TorsionState state;

  /// Hertz pressure and circumferential traction at a distance from the axis in m; zero outside the contact.
  double pressure(double radius) const;
  double traction(double radius) const;
};

/// The oracle, or why there is none. A load given as a ratio is the same ratio of the exact limit moment.
struct OracleAnswer {
  std::optional<Oracle> oracle;
  std::string reason;
};
OracleAnswer find_oracle(const solver::Scene& scene);

}  // namespace slipstick::convergence
