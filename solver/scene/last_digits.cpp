#include "solver/scene/last_digits.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "solver/scene/surface_geometry.hpp"

namespace slipstick::solver {
namespace {

bool is_rounding(double value, double scale) { return value != 0.0 && std::abs(value) <= kLastDigits * scale; }

double compliance(const Material& body) { return (1.0 + body.poisson_ratio) / body.young_modulus; }

/// Sides of the grid, or half the sides of the contact; none if they are unknown before the solve or leave
/// double precision's range.
std::optional<std::array<double, 2>> sides_of(const Scene& scene) {
  const auto& load = scene.steps.front().normal;
  if (scene.grid.extent || !load || !is_bare(scene)) return scene.grid.extent;
  const auto plane = [](const Material& body) { return (1.0 - body.poisson_ratio) * compliance(body); };
  try {
    return expected_half_sides(scene.surfaces, scene.combine, *load, 1.0 / (plane(scene.upper) + plane(scene.lower)));
  } catch (const std::logic_error&) {  // std::domain_error, std::invalid_argument
    return std::nullopt;
  }
}

/// The largest force times the grid's length over the largest moment. Only Coulomb's law converts a moment
/// ratio to a moment before the solve.
double forces_over_torsion(const Scene& scene, double reach) {
  double force = 0.0;
  double torsion = 0.0;
  for (const Step& step : scene.steps) {
    force = std::max(force, std::hypot(step.force[0], step.force[1]));
    const auto ratio = value_if<MomentRatio>(step.torsion);
    const double limit =
        scene.contact.friction.is_coulomb() ? scene.contact.friction.coefficient * step.normal.value_or(0.0) : 0.0;
    const double moment = value_if<Moment>(step.torsion).value_or(0.0) / reach;
    torsion = std::max(torsion, std::abs(ratio ? *ratio * limit : moment));
  }
  return force / torsion;
}

}  // namespace

bool are_alike(const Material& upper, const Material& lower) {
  const auto along = [](const Material& body) { return (1.0 - 2.0 * body.poisson_ratio) * compliance(body); };
  return std::abs(along(upper) - along(lower)) <= kLastDigits * (compliance(upper) + compliance(lower));
}

Scene without_last_digits(Scene scene) {
  const auto sides = sides_of(scene);
  if (scene.solver.model == ModelChoice::full || !sides) return scene;
  const auto left_out = [&](const std::string& what) {
    scene.left_out.push_back({what, "less than 1e-12 of the quantity that it changes"});
  };
  for (Surface& surface : scene.surfaces) {
    for (std::size_t i = 0; i < 2; ++i) {
      if (!is_rounding(surface.at[i], (*sides)[i])) continue;
      surface.at[i] = 0.0;
      left_out("a shape's position");
    }
    if (!is_rounding(surface.radius_2 - surface.radius_1, surface.radius_1)) continue;
    surface.radius_2 = surface.radius_1;
    left_out("the difference of the radii");
  }
  if (is_rounding(forces_over_torsion(scene, std::hypot((*sides)[0], (*sides)[1])), 1.0)) {
    for (Step& step : scene.steps) step.force = {};
    left_out("forces");
  }
  return scene;
}

}  // namespace slipstick::solver
