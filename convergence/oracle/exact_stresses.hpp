#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "convergence/oracle/errors.hpp"
#include "solver/stresses/subsurface_stresses.hpp"

namespace slipstick::convergence {

/// Exact stresses below the surface of a body, Pa, in the axes of the scene.
struct ExactStresses {
  double contact_radius;         ///< m
  std::array<double, 2> centre;  ///< m
  /// At points x1, x2, depth, m. Throws std::domain_error where a stress is infinite.
  std::function<std::vector<solver::PointStresses>(const std::vector<std::array<double, 3>>& points, double poisson)>
      at;
};

/// After the last step of the scene. None, with the reason, where the scene has no exact stresses.
std::optional<ExactStresses> exact_stresses(const solver::Scene& scene, solver::Body body, std::string& reason);

/// Errors of a solution's stresses, over all six components at 24 points in a plane at 0.4 contact radii of
/// depth, out to 1.5 radii, in the lower body, or the upper one if the lower is rigid. NaN, with the reason,
/// where the scene has no exact stresses or a layer.
FieldError stress_error(const solver::Scene& scene, const solver::Solution& solution, std::string& reason);

}  // namespace slipstick::convergence
