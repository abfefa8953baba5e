#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "analytic/shear_bounds.hpp"
#include "convergence/oracle/exact_theories.hpp"

namespace slipstick::convergence {
namespace {

analytic::layered::Elastic elastic(const solver::Material& material) {
  return {.shear_modulus = 0.5 * material.young_modulus / (1.0 + material.poisson_ratio),
          .poisson_ratio = material.poisson_ratio};
}

analytic::layered::Body body(const solver::Material& material) {
  if (!material.coating) return {elastic(material)};
  return {elastic(surface_material(material)), analytic::layered::Coat{material.coating->thickness, elastic(material)}};
}

std::optional<analytic::layered::Indenter> indenter(const solver::Surface& surface) {
  const auto shape = exact_shape(surface);
  if (shape && shape->profile == "hertz") return analytic::layered::Indenter::sphere;
  if (shape && shape->profile == "flat_punch") return analytic::layered::Indenter::flat_punch;
  return std::nullopt;
}

/// Numbers of a body that must be equal for its pressure to move it as another.
auto numbers(const solver::Material& material) {
  const solver::Coating coating = material.coating.value_or(solver::Coating{});
  return std::array{material.young_modulus, material.poisson_ratio, coating.thickness, coating.young_modulus,
                    coating.poisson_ratio};
}

}  // namespace

std::optional<ExactShape> exact_shape(const solver::Surface& surface) {
  using solver::Shape;
  switch (surface.shape) {
    case Shape::sphere:
      return ExactShape{"hertz", {surface.radius}, 2.0};
    case Shape::ellipsoid:
      if (is_elliptic(surface)) return std::nullopt;
      return ExactShape{"hertz", {surface.radius_1}, 2.0};
    case Shape::cone:
      return ExactShape{"cone", {surface.slope}, 1.0};
    case Shape::flat_punch:
      if (surface.inner_radius > 0.0) return std::nullopt;
      return ExactShape{"flat_punch", {surface.radius}, std::numeric_limits<double>::infinity()};
    case Shape::rounded_punch:
      return ExactShape{"rounded_punch", {surface.flat_radius, surface.corner_radius}, std::nullopt};
    case Shape::power:
      return ExactShape{fmt::format("power:{}", surface.exponent), {surface.coefficient}, surface.exponent};
    case Shape::height_map:
    case Shape::roughness:
      break;
  }
  return std::nullopt;
}

bool is_elliptic(const solver::Surface& surface) {
  return surface.shape == solver::Shape::ellipsoid && surface.radius_1 != surface.radius_2;
}

std::optional<FrictionBound> find_friction_bound(const solver::FrictionLaw& law,
                                                 std::shared_ptr<const analytic::Profile> pressure,
                                                 double reference_pressure) {
  const bool hertz = pressure.get() == &analytic::hertz_profile();
  const double by_coefficient = law.coefficient * reference_pressure;
  if (!law.map.empty() || law.factors) return std::nullopt;
  switch (law.kind) {
    case solver::FrictionKind::coulomb:
      return FrictionBound{std::move(pressure), by_coefficient};
    case solver::FrictionKind::tresca:
      return FrictionBound{{&analytic::constant_bound_profile(), [](const analytic::Profile*) {}}, law.shear_strength};
    case solver::FrictionKind::capped:
      if (!hertz) return std::nullopt;
      return FrictionBound{analytic::capped_hertz_profile(std::min(1.0, law.shear_strength / by_coefficient)),
                           by_coefficient};
    case solver::FrictionKind::power:
      if (!hertz) return std::nullopt;
      return FrictionBound{analytic::power_of_hertz_profile(law.exponent),
                           law.coefficient * std::pow(reference_pressure, law.exponent)};
  }
  return std::nullopt;
}

solver::Material surface_material(const solver::Material& body) {
  if (!body.coating) return body;
  return {body.coating->young_modulus, body.coating->poisson_ratio};
}

std::string coated_obstacle(const solver::Scene& scene) {
  const solver::Surface& surface = scene.surfaces.front();
  if (!indenter(surface))
    return fmt::format("no exact solution is known here for shape = \"{}\" on a layer", to_string(surface.shape));
  if (!scene.contact.friction.is_coulomb())
    return fmt::format("no exact solution is known here for friction_law = \"{}\" on a layer",
                       to_string(scene.contact.friction.kind));
  if (scene.contact.coupling != solver::Coupling::none && numbers(scene.upper) != numbers(scene.lower))
    return "the pressure's tangential displacement of coated bodies enters (contact.coupling)";
  const bool forces = std::any_of(scene.steps.begin(), scene.steps.end(), solver::brings_translation);
  return forces ? "no exact solution is known here for a force on a layer" : "";
}

analytic::layered::LayeredContact press_coated(const solver::Scene& scene, double load) {
  const analytic::layered::Pair pair(body(scene.lower), body(scene.upper));
  const solver::Surface& surface = scene.surfaces.front();
  return press(indenter(surface).value(), load, exact_shape(surface).value().numbers.front(), pair);
}

}  // namespace slipstick::convergence
