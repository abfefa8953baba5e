#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// How a person names what a loop is of.
struct LoopWords {
  const char* load;         ///< moment
  const char* motion;       ///< rotation
  const char* load_unit;    ///< N m
  const char* motion_unit;  ///< rad
  const char* rate_unit;    ///< of a thousandth: mrad/s
};

/// A law of first loading, and whose it is.
struct NamedLoading {
  std::string name;  ///< a cone
  std::function<double(double)> loading;
};

/// The contact that a loop is held to: its exact law, as m = load over limit at t, the motion in its unit.
struct LoopContact {
  std::function<double(double)> loading;  ///< m at t of first loading, odd
  double stiffness;                       ///< dm/dt at rest
  double normal_load;                     ///< N
  double limit;                           ///< N m or N, of m = 1
  double motion_unit;                     ///< rad or m, of t = 1
  double limit_exponent;                  ///< power of the normal load that the limit goes like
  double stiffness_exponent;              ///< and the stiffness at rest
  double one_body_upper;                  ///< stiffness with the lower body rigid, over the pair's; and
  double one_body_lower;                  ///< with the upper one; infinite where that is rigid itself
  /// Of torsion: the limit of a uniform pressure over the exact one.
  std::optional<double> uniform_pressure_limit;
  std::optional<double> sphere_limit;  ///< of a sphere in torsion, M_lim/(mu W a), for the paper's Eq. (7)
  /// The first loading of other profiles of the same radius, and their names.
  std::vector<NamedLoading> other_profiles;
  double law_error;  ///< relative, of loading
  LoopWords words;
};

/// Torsion of the scene's contact under a normal load. Throws InputError where it has no exact law.
LoopContact torsion_contact(const solver::Scene& scene, double normal_load);

/// A tangential force on it: Cattaneo's and Mindlin's law, which is exact where Poisson's ratios are 0, and
/// else leaves out the slip across the force. Throws InputError where the contact does not stay similar to
/// itself under other normal loads.
LoopContact force_contact(const solver::Scene& scene, double normal_load);

}  // namespace slipstick::convergence
