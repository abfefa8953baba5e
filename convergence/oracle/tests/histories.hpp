#pragma once

#include <string>
#include <vector>

#include "solver/scene/scene.hpp"

/// Scenes whose loads go through several steps.
namespace slipstick::convergence {

inline solver::Scene scene_of(const std::string& name) {
  return solver::read_scene(std::string(SLIPSTICK_SCENES) + "/" + name + ".toml");
}

/// Where Cattaneo's and Mindlin's solution is exact.
inline solver::Scene without_contraction(solver::Scene scene) {
  scene.upper.poisson_ratio = scene.lower.poisson_ratio = 0.0;
  return scene;
}

/// One step for each ratio of the limit moment, under the scene's normal load.
inline solver::Scene twisted(solver::Scene scene, const std::vector<double>& ratios) {
  const solver::Step first = scene.steps.front();
  scene.steps.assign(ratios.size(), first);
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    scene.steps[i].key = "step[" + std::to_string(i) + "]";
    scene.steps[i].torsion = solver::MomentRatio{ratios[i]};
  }
  return scene;
}

/// In N.
struct Push {
  double normal;
  double force;
};

/// One step for each push, along a line oblique to the grid; no torsion.
inline solver::Scene pushed(solver::Scene scene, const std::vector<Push>& pushes) {
  scene = twisted(scene, std::vector<double>(pushes.size(), 0.0));
  for (std::size_t i = 0; i < pushes.size(); ++i) {
    scene.steps[i].normal = pushes[i].normal;
    scene.steps[i].force = {0.6 * pushes[i].force, 0.8 * pushes[i].force};
  }
  return scene;
}

}  // namespace slipstick::convergence
