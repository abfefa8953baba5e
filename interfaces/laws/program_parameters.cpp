#include "interfaces/laws/law_files.hpp"

#include <cmath>
#include <numbers>

#include "analytic/torsion.hpp"

namespace slipstick::laws {

using namespace convergence;

namespace {

/// The rotation at 0.9 of the limit, in units of rotation.
double presliding(const ContactLaw& law) {
  return law.rotation_unit() * analytic::from_moment_ratio(0.9, *law.contact.profile).twist;
}

}  // namespace

LammpsTwisting lammps_twisting(const ContactLaw& law) {
  const double limit = law.limit_moment();
  return {.stiffness = law.best_spring.stiffness * limit / law.rotation_unit(),
          .arm = law.contact.units ? limit / law.contact.units->normal_load : limit,
          .error = law.best_spring.error,
          .marshall_cap_error = uniform_pressure_cap_error(*law.contact.profile)};
}

std::optional<MujocoFriction> mujoco_friction(const ContactLaw& law) {
  if (!law.contact.units) return std::nullopt;
  const LawUnits& units = *law.contact.units;
  return MujocoFriction{.sliding = units.friction,
                        .torsional = law.limit_moment() / units.normal_load,
                        .lost_presliding = presliding(law),
                        .combined_error = law.limit.ellipsoid_error};
}

std::optional<DrakeHydroelastic> drake_hydroelastic(const ContactLaw& law) {
  if (!law.contact.units || !law.contact.units->sphere_radius) return std::nullopt;
  const LawUnits& units = *law.contact.units;
  const double radius = *units.sphere_radius;
  constexpr double kParabolicArm = 8.0 / 15.0;
  const double contact_radius = law.limit_moment() / (kParabolicArm * units.friction * units.normal_load);
  return DrakeHydroelastic{
      .mu_dynamic = units.friction,
      .modulus = 4.0 * radius * radius * units.normal_load / (std::numbers::pi * std::pow(contact_radius, 4)),
      .contact_radius = contact_radius,
      .half_load_error = std::pow(2.0, 4.0 / 3.0 - 5.0 / 4.0) - 1.0,
      .lost_presliding = presliding(law)};
}

}  // namespace slipstick::laws
