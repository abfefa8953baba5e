#pragma once

#include <memory>
#include <optional>
#include <string>

#include "analytic/axisymmetric.hpp"
#include "convergence/laws/limit_surface.hpp"
#include "convergence/laws/parallel_elements.hpp"
#include "convergence/laws/twist_law.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// The units in which the dimensionless law is a scene's, SI.
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

/// The contact that a law describes.
struct LawContact {
  std::string name;
  std::shared_ptr<const analytic::Profile> profile;
  std::optional<LawUnits> units;     ///< none: dimensionless
  std::string prefix = "slipstick";  ///< of names in files: letters, digits and _, no digit first
};

/// The contact of a scene under its first normal load. Throws InputError, with the reason, for a scene whose
/// torsion has no exact law.
LawContact law_contact(const solver::Scene& scene);

/// Errors and sizes of a law's forms.
struct LawOptions {
  double error = 1e-6;               ///< relative, of the polynomials
  double table_error = 1e-4;         ///< over the limit, of the table
  double element_error = 1e-2;       ///< over the limit, of the elements on first loading
  std::optional<int> elements = {};  ///< a number of elements, instead of their error
  int limit_loads = 65;
};

/// A spring with a cap, as many programs have it: min(stiffness t, 1), and how far that is from m at most.
struct SpringAndCap {
  double stiffness;  ///< m over t
  double error;
};

/// The law in several forms. They are dimensionless; contact.units turn them into the scene's.
struct ContactLaw {
  LawContact contact;
  TwistLaw law;
  StateTable table;
  ParallelElements elements;
  LimitSurface limit;
  SpringAndCap rest_spring;  ///< with the exact stiffness at rest
  SpringAndCap best_spring;  ///< with the stiffness of the least error

  double rotation_unit() const { return contact.units ? contact.units->rotation() : 1.0; }
  double moment_unit() const { return contact.units ? contact.units->moment() : 1.0; }
  /// The limit, in units of moment.
  double limit_moment() const { return law.moment_limit * moment_unit(); }
};

/// Throws std::domain_error, naming the number, where an option is out of range.
ContactLaw make_contact_law(const LawContact& contact, const LawOptions& options);

/// The cap at which granular codes let a sphere spin, over its exact limit, less 1: (2/3) mu W a is that of a
/// uniform pressure.
double uniform_pressure_cap_error(const analytic::Profile& profile);

}  // namespace slipstick::convergence
