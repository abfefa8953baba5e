#pragma once

#include <gtest/gtest.h>

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
  /// The short scene under the pressure of the file p.csv, which gets this text; on 4 x 4 cells of 0.25 mm.
  Scene pressed(const std::string& table, const std::vector<std::string>& more = {}) const {
    write("p.csv", table);
    std::string text = kShortScene;
    text.erase(text.find("normal = 1000\n"), 14);
    std::vector<std::string> overrides{"contact.pressure=file", "contact.pressure_file=p.csv", "grid.cells=[4, 4]",
                                       "grid.extent=[0.001, 0.001]"};
    overrides.insert(overrides.end(), more.begin(), more.end());
    return read(text, overrides);
  }
  /// The short scene with the heights of the file heights.csv, which gets this text, for an indenter.
  Scene mapped(const std::string& heights, const std::string& spacing,
               const std::vector<std::string>& overrides = {}) const {
    write("heights.csv", heights);
    std::string text = with_surface("shape = \"height_map\"\nfile = \"heights.csv\"\nspacing = " + spacing + "\n");
    return read(text.erase(text.find("[grid]")), overrides);
  }
};

}  // namespace slipstick::solver
