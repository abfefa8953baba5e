#pragma once

#include <optional>
#include <string>
#include <vector>

#include "convergence/check/loops/loop_path.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// Names of a loop's quantities and units in sentences.
struct LoopWords {
  const char* load;       ///< moment
  const char* motion;     ///< rotation
  const char* rate_unit;  ///< of a thousandth: mrad/s
};

/// The first loading of a named profile.
struct NamedLoading {
  std::string name;  ///< a cone
  LoadingCurve loading;
};

/// The contact that a loop is compared with. Its exact law: m, the load over the limit, at t, the motion in
/// its unit.
struct LoopContact {
  LoadingCurve loading;
  double stiffness;           ///< dm/dt at rest
  double normal_load;         ///< N
  double limit;               ///< N m or N, of m = 1
  double motion_unit;         ///< rad or m, of t = 1
  double limit_exponent;      ///< d ln(limit)/d ln(normal load)
  double stiffness_exponent;  ///< d ln(stiffness at rest)/d ln(normal load)
  double one_body_upper;      ///< stiffness with the lower body rigid, over the pair's
  double one_body_lower;      ///< stiffness with the upper body rigid; infinite if the lower one is
  /// The limit of a uniform pressure over the exact one; only for torsion.
  std::optional<double> uniform_pressure_limit;
  std::optional<double> sphere_limit;  ///< of a sphere in torsion, M_lim/(mu W a), for the paper's Eq. (7)
  /// The first loading of other profiles of the same radius, and their names.
  std::vector<NamedLoading> other_profiles;
  double law_error;  ///< relative, of loading
  LoopWords words;
};

/// Torsion of the scene's contact under a normal load. Throws InputError where it has no exact law.
LoopContact torsion_contact(const solver::Scene& scene, double normal_load);

/// A tangential force on the scene's contact: Cattaneo's and Mindlin's law, which is exact for Poisson's
/// ratios of 0 and otherwise neglects slip across the force. Throws InputError for a contact that is not
/// self-similar under other normal loads.
LoopContact force_contact(const solver::Scene& scene, double normal_load);

}  // namespace slipstick::convergence
