#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "solver/input/tests/complaint.hpp"
#include "solver/input/tests/scratch_folder.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::solver {

inline constexpr const char* kShortScene = R"([upper]
shape = "sphere"
radius = 0.018
young_modulus = 210e9
poisson_ratio = 0.3
[lower]
young_modulus = 210e9
poisson_ratio = 0.3
[contact]
friction = 0.1
[load]
normal = 1000
moment_ratio = 0.9
[grid]
cells = [32, 32]
)";

/// The short scene with other keys for its sphere, and tables at the end.
inline std::string with_surface(const std::string& keys, const std::string& tables = "") {
  std::string text = kShortScene;
  const std::string sphere = "shape = \"sphere\"\nradius = 0.018\n";
  return text.replace(text.find(sphere), sphere.size(), keys) + tables;
}

class SceneFile : public ScratchFolder {
 protected:
  Scene read(const std::string& text, const std::vector<std::string>& overrides = {}) const {
    return read_scene(write("scene.toml", text), overrides);
  }
};

}  // namespace slipstick::solver
