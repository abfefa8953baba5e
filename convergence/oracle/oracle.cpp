#include "convergence/oracle/oracle.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "convergence/oracle/exact_theories.hpp"
#include "solver/elasticity/law/law_kind.hpp"
#include "solver/scene/last_digits.hpp"

namespace slipstick::convergence {
namespace {

/// Whether the pressure moves the two surfaces sideways by different amounts, and the scene includes that.
bool is_coupled(const solver::Scene& scene) {
  return scene.contact.coupling != solver::Coupling::none && !are_alike(scene.upper, scene.lower);
}

/// Why no theory holds for a scene; empty if one may.
std::string obstacle(const solver::Scene& scene) {
  const solver::FrictionLaw& law = scene.contact.friction;
  const solver::Surface& surface = scene.surfaces.front();
  const bool has_shape = exact_shape(surface).has_value();
  if (scene.surfaces.size() > 1) return "no exact solution is known here for several shapes";
  if (!has_shape && !is_elliptic(surface)) {
    return fmt::format("no exact solution is known here for shape = \"{}\"{}", to_string(surface.shape),
                       surface.inner_radius > 0.0 ? " with an inner radius" : "");
  }
  if (scene.layer.kind != nullptr) {
    return fmt::format("no exact solution is known here for layer.kind = \"{}\"", scene.layer.kind->word);
  }
  if (scene.contact.pressure == solver::PressureModel::file) return "the pressure comes from a file";
  if (scene.ends_at_grid_edge) return "the body may end at the grid's edge (upper.ends_at_grid_edge)";
  if (law.is_frictionless()) return "without friction there is no traction";
  if (!law.map.empty()) return "the friction comes from a map (contact.friction_map)";
  const bool any_shape = law.kind == solver::FrictionKind::coulomb || law.kind == solver::FrictionKind::tresca;
  if ((any_shape && has_shape) || law.is_coulomb() || surface.shape == solver::Shape::sphere) return "";
  return fmt::format("no exact solution is known here for shape = \"{}\" under friction_law = \"{}\"",
                     to_string(surface.shape), to_string(law.kind));
}

bool without_torsion(const solver::Step& step) {
  const solver::TorsionLoad& load = step.torsion;
  return std::visit([](const auto& kind) { return kind.value == 0.0; }, load);
}

bool without_force(const solver::Step& step) { return !step.displacement && step.force == std::array<double, 2>{}; }

/// Two directions are one line where the sine between them is less: the rounding of two coordinates.
constexpr double kSameLine = 1e-14;

/// The line along which all forces act, as a unit vector; none if there are several.
std::optional<std::array<double, 2>> line_of_forces(const std::vector<solver::Step>& steps) {
  std::array<double, 2> line{};
  for (const solver::Step& step : steps) {
    const auto& [f1, f2] = step.force;
    const double size = std::hypot(f1, f2);
    if (size == 0.0) continue;
    if (line == std::array<double, 2>{}) line = {f1 / size, f2 / size};
    if (std::abs(line[0] * f2 - line[1] * f1) > kSameLine * size) return std::nullopt;
  }
  return line;
}

bool has_no_cross_contraction(const solver::Material& material) {
  return material.poisson_ratio == 0.0 || std::isinf(material.young_modulus);
}

ExactTheory history_under_force(const solver::Scene& scene) {
  if (!scene.contact.friction.is_coulomb())
    return no_theory("Cattaneo's and Mindlin's solution belongs to Coulomb's law");
  const std::optional<ExactShape> shape = exact_shape(scene.surfaces.front());
  const auto line = line_of_forces(scene.steps);
  if (std::any_of(scene.steps.begin(), scene.steps.end(), [](const auto& s) { return s.displacement; })) {
    return no_theory("the displacement is imposed, not the force");
  }
  if (!has_no_cross_contraction(scene.upper) || !has_no_cross_contraction(scene.lower)) {
    return no_theory("Cattaneo's and Mindlin's solution is exact only where Poisson's ratios are 0");
  }
  if (!line) return no_theory("no exact solution is known here for forces along several lines");
  if (!shape || !shape->gap_exponent)
    return no_theory("the contact does not stay similar to itself as the load changes");
  return force_history(scene, *shape->gap_exponent, *line);
}

ExactTheory history_of_dissimilar(const solver::Scene& scene) {
  const auto& steps = scene.steps;
  const bool pressed_only = std::all_of(steps.begin(), steps.end(), [](const solver::Step& step) {
    return without_torsion(step) && without_force(step);
  });
  const bool growing =
      scene.cycles == 1 &&
      std::is_sorted(steps.begin(), steps.end(), [](const auto& a, const auto& b) { return *a.normal < *b.normal; });
  const std::optional<ExactShape> shape = exact_shape(scene.surfaces.front());
  if (!pressed_only || !growing || !shape || !shape->gap_exponent || !scene.contact.friction.is_coulomb()) {
    return no_theory("the pressure's tangential displacement of dissimilar materials enters (contact.coupling)");
  }
  try {
    return frictional_indentation(scene);
  } catch (const std::exception& error) {
    return no_theory(error.what());
  }
}

ExactTheory theory_of(const solver::Scene& scene) {
  const std::string reason = obstacle(scene);
  if (!reason.empty()) return no_theory(reason);
  const std::string under_layer = is_coated(scene) ? coated_obstacle(scene) : "";
  if (!under_layer.empty()) return no_theory(under_layer);
  if (!is_coated(scene) && is_coupled(scene)) return history_of_dissimilar(scene);
  if (is_elliptic(scene.surfaces.front())) return pressed_ellipse(scene);
  const auto& steps = scene.steps;
  if (!std::all_of(steps.begin(), steps.end(), without_force)) {
    if (std::all_of(steps.begin(), steps.end(), without_torsion)) return history_under_force(scene);
    return no_theory("no exact solution is known here for torsion together with a force");
  }
  const bool constant_load = std::all_of(steps.begin(), steps.end(),
                                         [&](const solver::Step& step) { return step.normal == steps.front().normal; });
  if (!constant_load) return no_theory("no exact solution is known here for torsion while the normal load changes");
  try {
    return torsion_history(scene);
  } catch (const std::domain_error& error) {
    const char* const on_layer = is_coated(scene) ? "the contact on the layer is not one that is known here: " : "";
    return no_theory(on_layer + std::string(error.what()));
  }
}

}  // namespace

double Oracle::radius(double y1, double y2) const {
  if (place.axis_ratio == 1.0) return std::hypot(y1, y2);
  const double along = std::cos(place.angle) * y1 + std::sin(place.angle) * y2;
  const double across = std::cos(place.angle) * y2 - std::sin(place.angle) * y1;
  return std::sqrt(along * along / place.axis_ratio + across * across * place.axis_ratio);
}

double Oracle::longer_semi_axis() const {
  return contact_radius * std::sqrt(std::max(place.axis_ratio, 1.0 / place.axis_ratio));
}

double Oracle::shorter_semi_axis() const {
  return contact_radius * std::sqrt(std::min(place.axis_ratio, 1.0 / place.axis_ratio));
}

double Oracle::pressure(double radius) const {
  const double ratio = radius / contact_radius;
  if (std::isnan(ratio)) return ratio;
  return ratio < 1.0 ? normal.reference_pressure * normal.profile->pressure(ratio) : 0.0;
}

double Oracle::traction(double radius) const {
  if (!shear) return NAN;
  return radius < contact_radius ? shear(radius) : 0.0;
}

OracleAnswer ExactHistory::advance(const solver::Step& step) {
  if (left_) return {std::nullopt, "a step before left the range of the exact solution"};
  OracleAnswer answer = theory_(step);
  left_ = answer.out_of_range;
  return answer;
}

ExactHistory exact_history(const solver::Scene& scene) { return ExactHistory(theory_of(scene)); }

OracleAnswer find_oracle(const solver::Scene& scene) { return exact_history(scene).advance(scene.steps.front()); }

}  // namespace slipstick::convergence
