#pragma once

#include <string>
#include <vector>

#include "solver/input/tests/scratch_folder.hpp"
#include "solver/scene/scene.hpp"

/// Helpers of the tests of convergence/.
namespace slipstick::convergence {

/// A scene of convergence/scenes/.
inline solver::Scene example(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return solver::read_scene(std::string(SLIPSTICK_SCENES) + "/" + name + ".toml", overrides);
}

}  // namespace slipstick::convergence
