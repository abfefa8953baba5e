#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "convergence/laws/contact_law.hpp"
#include "convergence/results/result_parts.hpp"

/// A contact law as files that other programs read. Numbers are the scene's, SI, or dimensionless.
namespace slipstick::laws {

using convergence::ContactLaw;
using convergence::Json;

/// The file's text by its ending: .csv table; .h C header; .py Python module; .table LAMMPS; .inp Abaqus;
/// .xml MuJoCo; .sdf Drake. Throws InputError for another ending, and where a form needs units, or a sphere,
/// that the law has not.
std::string law_file(const ContactLaw& law, const std::filesystem::path& path);

/// The first lines of a file, each with `before` in front: the contact and the units.
std::string law_heading(const ContactLaw& law, const std::string& before);

/// The prefix of the law's names, in capitals.
std::string capital_prefix_of(const ContactLaw& law);

std::string c_header(const ContactLaw& law);
std::string python_module(const ContactLaw& law);

/// Rows of first loading: rotation, moment, stick_ratio, tangent_stiffness, energy_lost_per_cycle.
std::string csv_table(const ContactLaw& law);
/// A section as LAMMPS' bond_style table reads them, energy and its negative derivative over the rotation, at
/// equal steps: read with as many values as it has rows, LAMMPS takes these as they are.
std::string lammps_table(const ContactLaw& law);
/// Connector behaviours: nonlinear elastic first loading; the elements, elastic and plastic, in parallel.
std::string abaqus_behaviours(const ContactLaw& law);

/// MuJoCo needs units, Drake a sphere.
std::string mujoco_default(const ContactLaw& law);
std::string drake_model(const ContactLaw& law);

// ---------------------------------------------------------------- other programs' own laws
// (program_parameters.cpp) Parameters of their friction laws that fit a contact best, and the errors that
// remain.

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

// ---------------------------------------------------------------- the result (law_result.cpp)

/// All forms of a law with their errors.
Json law_json(const ContactLaw& law);

/// The result in a few lines of text.
std::string law_text(const ContactLaw& law);

}  // namespace slipstick::laws
