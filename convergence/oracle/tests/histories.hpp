#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "convergence/oracle/oracle.hpp"
#include "convergence/tests/scratch_folder.hpp"

/// Scenes whose loads go through several steps.
namespace slipstick::convergence {

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

/// The loads of pressure and shear: the integrals of p, |q| r and |q| over the contact.
struct CarriedLoads {
  double load = 0.0;
  double moment = 0.0;
  double force = 0.0;
};

/// By the midpoint rule in r = sin(t), which takes off what a flat punch's edge has too much, on both sides
/// of the stick edge, where the traction has a vertical tangent.
inline CarriedLoads loads_carried_by(const Oracle& oracle) {
  constexpr int points = 4000;
  constexpr double step = std::numbers::pi / 2 / points;
  CarriedLoads carried;
  for (const auto& [from, to] :
       {std::pair(0.0, oracle.stick_radius), std::pair(oracle.stick_radius, oracle.contact_radius)}) {
    for (int i = 0; i < points; ++i) {
      const double t = step * (i + 0.5);
      const double r = from + (to - from) * std::sin(t);
      const double ring = step * (to - from) * std::cos(t) * 2.0 * std::numbers::pi * r;
      carried.load += ring * oracle.pressure(r);
      carried.moment += ring * r * oracle.traction(r);
      carried.force += ring * oracle.traction(r);
    }
  }
  return carried;
}

}  // namespace slipstick::convergence
