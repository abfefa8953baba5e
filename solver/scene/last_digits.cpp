#include "solver/scene/last_digits.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/scene/surface_geometry.hpp"

namespace slipstick::solver {
namespace {

/// Over a scale that is positive; nothing is already 0.
bool is_rounding(double value, double scale) {
  return value != 0.0 && std::abs(value) <= kLastDigits * scale;
}

double compliance(const Material& body) { return (1.0 + body.poisson_ratio) / body.young_modulus; }

/// Sides of a cell, as far as they are known before the solve.
std::optional<std::array<double, 2>> cell_of(const Scene& scene) {
  auto sides = scene.extent;
  if (const auto& load = scene.steps.front().normal; !sides && load) {
    const auto plane = [](const Material& body) { return (1.0 - body.poisson_ratio) * compliance(body); };
    sides = expected_half_sides(scene.surfaces, scene.combine, *load,
                                1.0 / (plane(scene.upper) + plane(scene.lower)));
  }
  if (sides) {
    for (std::size_t i = 0; i < 2; ++i) (*sides)[i] /= static_cast<double>(scene.cells[i]);
  }
  return sides;
}

/// Of all steps, as forces; that of torsion is no larger than what moves the contact's edge.
struct LargestLoads {
  double force = 0.0, torsion = 0.0;
};
LargestLoads largest_loads(const Scene& scene, const std::array<double, 2>& cell) {
  const double reach = std::hypot(cell[0] * static_cast<double>(scene.cells[0]),
                                  cell[1] * static_cast<double>(scene.cells[1]));
  LargestLoads largest;
  for (const Step& step : scene.steps) {
    largest.force = std::max(largest.force, std::hypot(step.force[0], step.force[1]));
    const auto ratio = value_if<MomentRatio>(step.torsion);
    const auto moment = value_if<Moment>(step.torsion);
    const double of_torsion = ratio    ? *ratio * scene.friction * step.normal.value_or(0.0)
                              : moment ? *moment / reach
                                       : 0.0;
    largest.torsion = std::max(largest.torsion, std::abs(of_torsion));
  }
  return largest;
}

}  // namespace

bool are_alike(const Material& upper, const Material& lower) {
  const auto along = [](const Material& body) { return (1.0 - 2.0 * body.poisson_ratio) * compliance(body); };
  return std::abs(along(upper) - along(lower)) <= kLastDigits * (compliance(upper) + compliance(lower));
}

Scene without_last_digits(Scene scene) {
  if (scene.model == ModelChoice::full) return scene;
  const auto leave_out = [&](double& value, double scale, double without, const std::string& what) {
    if (!is_rounding(value - without, scale)) return;
    value = without;
    scene.left_out.push_back({what, fmt::format("less than {:g} of what it belongs to", kLastDigits)});
  };
  for (Material* const body : {&scene.upper, &scene.lower}) {
    leave_out(body->poisson_ratio, 1.0, 0.0, "a Poisson's ratio");
  }
  for (Surface& surface : scene.surfaces) {
    leave_out(surface.radius_2, surface.radius_1, surface.radius_1, "the difference of the radii");
  }
  for (std::size_t i = 1; i < scene.steps.size(); ++i) {
    const auto& before = scene.steps[i - 1].normal;
    if (auto& normal = scene.steps[i].normal; normal && before) {
      leave_out(*normal, *before, *before,
                fmt::format("a change of the normal load, {}", scene.steps[i].key));
    }
  }
  const auto cell = cell_of(scene);
  if (!cell) return scene;
  for (Surface& surface : scene.surfaces) {
    for (std::size_t i = 0; i < 2; ++i) leave_out(surface.at[i], (*cell)[i], 0.0, "a shape's position");
  }
  const LargestLoads largest = largest_loads(scene, *cell);
  const bool forces = is_rounding(largest.force, largest.torsion);
  const bool torsion = is_rounding(largest.torsion, largest.force);
  if (!forces && !torsion) return scene;
  for (Step& step : scene.steps) {
    if (forces) step.force = {};
    if (torsion && !std::holds_alternative<Twist>(step.torsion)) step.torsion = MomentRatio{0.0};
  }
  scene.left_out.push_back({forces ? "forces" : "torsion",
                            fmt::format("less than {:g} of all other tangential loads", kLastDigits)});
  return scene;
}

}  // namespace slipstick::solver
