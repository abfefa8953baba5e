#include "convergence/oracle/coated_contact.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "convergence/oracle/exact_shapes.hpp"

namespace slipstick::convergence {
namespace {

analytic::layered::Elastic elastic(const solver::Material& material) {
  return {.shear_modulus = 0.5 * material.young_modulus / (1.0 + material.poisson_ratio),
          .poisson_ratio = material.poisson_ratio};
}

analytic::layered::Body body(const solver::Material& material) {
  if (!material.coating) return {elastic(material)};
  return {elastic(surface_material(material)),
          analytic::layered::Coat{material.coating->thickness, elastic(material)}};
}

bool is_same(const solver::Material& one, const solver::Material& other) {
  const auto numbers = [](const solver::Material& material) {
    const solver::Coating coating = material.coating.value_or(solver::Coating{});
    return std::array{material.young_modulus, material.poisson_ratio, coating.thickness,
                      coating.young_modulus, coating.poisson_ratio};
  };
  return numbers(one) == numbers(other);
}

bool is_flat_punch(const solver::Surface& surface) {
  return surface.shape == solver::Shape::flat_punch && !(surface.inner_radius > 0.0);
}

}  // namespace

solver::Material surface_material(const solver::Material& body) {
  if (!body.coating) return body;
  return {body.coating->young_modulus, body.coating->poisson_ratio};
}

std::string coated_obstacle(const solver::Scene& scene) {
  const solver::Surface& surface = scene.surfaces.front();
  const auto shape = exact_shape(surface);
  if (!is_flat_punch(surface) && !(shape && shape->profile == "hertz")) {
    return fmt::format("no exact solution is known here for shape = \"{}\" on a layer",
                       to_string(surface.shape));
  }
  if (scene.coupling != solver::Coupling::none && !is_same(scene.upper, scene.lower)) {
    return "the pressure's tangential displacement of coated bodies enters (contact.coupling)";
  }
  const bool forces = std::any_of(scene.steps.begin(), scene.steps.end(), solver::brings_translation);
  return forces ? "no exact solution is known here for a force on a layer" : "";
}

analytic::layered::LayeredContact press_coated(const solver::Scene& scene, double load) {
  const analytic::layered::Pair pair(body(scene.lower), body(scene.upper));
  const double radius = exact_shape(scene.surfaces.front()).value().numbers.front();
  return is_flat_punch(scene.surfaces.front()) ? analytic::layered::press_flat_punch(load, radius, pair)
                                               : analytic::layered::press_sphere(load, radius, pair);
}

}  // namespace slipstick::convergence
