#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analytic/axisymmetric.hpp"
#include "analytic/torsion.hpp"
#include "convergence/laws/twist_law.hpp"
#include "solver/scene/scene.hpp"

/// The law of a contact in torsion, moment against rotation, in all the forms that other programs read.
namespace slipstick::convergence {

// ---------------------------------------------------------------- limit loads (limit_surface.cpp)

/// A load under which all of an axisymmetric contact slides, turning about a point at a distance from its
/// axis. The loads that the contact carries lie on one side of the plane through this one whose normal is
/// that motion: force * centre + moment is largest here (Goyal 1991).
struct LimitLoad {
  double centre;  ///< distance over a; infinite: it slides without turning
  double force;   ///< |F|/(mu W), perpendicular to the arm
  double moment;  ///< M/M_lim
};

/// The loads that a contact carries. The surface is symmetric about the axis of moments.
struct LimitSurface {
  std::vector<LimitLoad> loads;  ///< from pure moment to pure force
  /// Between loads next to each other the surface lies between their chord and their tangents, which are so
  /// far apart at most, over the distance from the origin.
  double gap;
  /// (F/(mu W))^2 + (M/M_lim)^2 = 1, which is used in its place (Howe and Cutkosky 1996): its distance from
  /// the origin over the exact one, less 1, where that is farthest from 0.
  double ellipsoid_error;
  LimitLoad ellipsoid_farthest;
};

/// Computes a number of loads, whose motions are spread evenly. Throws std::domain_error for fewer than 3.
LimitSurface limit_surface(const analytic::Profile& profile, int loads);

// ---------------------------------------------------------------- laws of straight lines
// (parallel_elements.cpp) Tables with linear interpolation, and springs with friction in parallel.
// Dimensionless as twist_law.hpp; errors are of m = M/M_lim, absolute.

/// States on the exact curve, from rest to where 1 - m is the error, straight lines between them, and the
/// last moment beyond.
struct StateTable {
  std::vector<analytic::TorsionState> rows;
  double error;  ///< the largest
};

/// A spring in series with a slider, as Jenkins and Iwan have them.
struct JenkinsElement {
  double stiffness;  ///< m over t
  double slip;       ///< m at which it slips
};

/// Jenkins elements side by side. Together they stick and slip as the contact does, Masing's rule included;
/// their slip moments sum up to 1, the exact limit.
///
/// After any rotations the error is e(x_0) - 2 e(x_1) + 2 e(x_2) - ... with e that of first loading, x_0 the
/// largest rotation and x_1 > x_2 > ... half the ranges of the branches still open. As x_0 >= x_1, it is a
/// sum of differences of e over intervals side by side: at most the total variation of e, which reversals at
/// its extremes reach.
struct ParallelElements {
  std::vector<JenkinsElement> elements;  ///< the first to slip first
  double error;          ///< the largest on first loading; on loops between t and -t three times that
  double history_error;  ///< the largest after any rotations: the total variation of that on first loading

  double moment_ratio_at(double twist) const;  ///< on first loading
};

/// The allowed errors of m, and the largest number of elements.
inline constexpr double kMinLineError = 1e-7;
inline constexpr double kMaxLineError = 0.5;
inline constexpr int kMaxElements = 200;

/// As few rows as keep the error. Throws std::domain_error for one out of range.
StateTable tabulate(const analytic::Profile& profile, double error);

/// Rows at equal steps of the rotation, for readers that draw cubic splines through them or step evenly: with
/// either, and with straight lines, the error is kept. Throws std::domain_error as tabulate().
StateTable tabulate_evenly(const analytic::Profile& profile, double error);

/// As few elements as keep the error, from 1e-5 on. Throws std::domain_error for one out of range.
ParallelElements parallel_elements(const analytic::Profile& profile, double error);

/// At most `count` elements (1 to kMaxElements, or std::domain_error), with the least error.
ParallelElements parallel_elements(const analytic::Profile& profile, int count);

// ---------------------------------------------------------------- all together (contact_law.cpp)

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

/// The cap at which granular codes let a sphere spin, over its exact limit, less 1: (2/3) mu W a is the limit
/// of a uniform pressure.
double uniform_pressure_cap_error(const analytic::Profile& profile);

}  // namespace slipstick::convergence
