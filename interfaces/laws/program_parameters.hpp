#pragma once

#include <optional>

#include "convergence/laws/contact_law.hpp"

/// Parameters of other programs' own friction laws that fit a contact best, and the errors that remain.
namespace slipstick::laws {

using convergence::ContactLaw;

/// LAMMPS, pair_style granular, `twisting sds`: a spring with a cap.
struct LammpsTwisting {
  double stiffness;  ///< k_twist: units of moment over rotation; the one of the least error
  double arm;        ///< mu_twist: the limit moment over the normal load, m; dimensionless: over mu a
  double error;      ///< largest error of the moment on first loading, over the limit
  double marshall_cap_error;  ///< of the limit that `twisting marshall` has under any stiffness
};

/// MuJoCo, condim 4, an elliptic cone: nothing rotates below the cap.
struct MujocoFriction {
  double sliding;          ///< mu
  double torsional;        ///< m: the limit moment over the normal load
  double lost_presliding;  ///< rotation at 0.9 of the limit, rad
  double combined_error;   ///< the ellipsoid's, at worst
};

/// Drake, a compliant hydroelastic sphere on a rigid half-space, whose pressure is E e, e the depth over the
/// radius: p0 (1 - (r/a_h)^2), so that the limit moment is (8/15) mu W a_h. The modulus makes it exact at
/// the contact's load.
struct DrakeHydroelastic {
  double mu_dynamic;
  double modulus;          ///< hydroelastic_modulus, Pa
  double contact_radius;   ///< a_h, m
  double half_load_error;  ///< of the limit at half of the load: it goes like W^(5/4), not W^(4/3)
  double lost_presliding;  ///< rad, as MuJoCo's
};

LammpsTwisting lammps_twisting(const ContactLaw& law);
/// None without units.
std::optional<MujocoFriction> mujoco_friction(const ContactLaw& law);
/// None without units, and for other contacts than spheres.
std::optional<DrakeHydroelastic> drake_hydroelastic(const ContactLaw& law);

}  // namespace slipstick::laws
