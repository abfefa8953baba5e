#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// A scene as the command line names it.
struct SceneFile {
  std::string file;
  std::vector<std::string> overrides = {};         ///< "key=value", as --set takes them
  std::optional<std::uint64_t> memory_limit = {};  ///< bytes that its solve may take

  /// Reads it; the overrides of `changed` come last and win. Throws InputError as solver::read_scene().
  solver::Scene read(const std::vector<std::string>& changed = {}) const {
    std::vector<std::string> all = overrides;
    all.insert(all.end(), changed.begin(), changed.end());
    solver::Scene scene = solver::read_scene(file, all);
    scene.solver.memory_limit = memory_limit;
    return scene;
  }
};

/// A number of a scene with its uncertainty.
struct UncertainInput {
  std::string key;   ///< for example contact.friction
  double value;      ///< in the scene
  std::string unit;  ///< behind the value, as " mm"; empty: none
  double relative;   ///< standard uncertainty over the value
};

/// Reads "key=5%". A key without its table means all numbers of that name in upper, lower, contact and load.
/// Throws InputError for a key that is no number of the scene, for a number that is zero, and for a
/// percentage that is not above 0 and below 100.
std::vector<UncertainInput> uncertain_inputs(const SceneFile& scene, const std::vector<std::string>& words);

}  // namespace slipstick::convergence
