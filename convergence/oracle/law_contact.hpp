#pragma once

#include <memory>
#include <optional>
#include <string>

#include "analytic/axisymmetric.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// The units in which the dimensionless law of torsion is a scene's, SI.
struct LawUnits {
  double friction;
  double normal_load;                        ///< N
  double contact_radius;                     ///< m
  double shear_modulus;                      ///< combined, Pa
  std::optional<double> sphere_radius = {};  ///< m, of a sphere on a half-space

  double moment() const { return friction * normal_load * contact_radius; }  ///< mu W a, N m
  double rotation() const {                                                  ///< mu W/(G a^2), rad
    return friction * normal_load / (shear_modulus * contact_radius * contact_radius);
  }
};

/// The contact that a law of torsion describes.
struct LawContact {
  std::string name;
  std::shared_ptr<const analytic::Profile> profile;
  std::optional<LawUnits> units;  ///< none: dimensionless
};

/// The contact of a scene under its first normal load. Throws InputError, with the reason, for a scene whose
/// torsion has no exact law.
LawContact law_contact(const solver::Scene& scene);

}  // namespace slipstick::convergence
