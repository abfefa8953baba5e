#include "convergence/oracle/law_contact.hpp"

#include <fmt/core.h>

#include "convergence/oracle/oracle.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

/// 1/G = sum of 2 (1 + nu)/E.
double combined_shear_modulus(const solver::Scene& scene) {
  const auto compliance = [](const solver::Material& body) {
    return 2.0 * (1.0 + body.poisson_ratio) / body.young_modulus;
  };
  return 1.0 / (compliance(scene.upper) + compliance(scene.lower));
}

}  // namespace

LawContact law_contact(const solver::Scene& scene) {
  solver::Scene unloaded = scene;
  unloaded.steps = {scene.steps.front()};
  unloaded.steps.front().torsion = solver::MomentRatio{0.0};
  unloaded.steps.front().force = {};
  unloaded.steps.front().displacement.reset();
  unloaded.cycles = 1;
  const OracleAnswer answer = find_oracle(unloaded);
  std::string reason = answer.oracle ? answer.oracle->only_normal : answer.reason;
  if (is_coated(scene)) reason = "the forms of the law are made for half-spaces without a layer";
  if (!reason.empty()) {
    throw solver::InputError(scene.source.string(),
                             fmt::format("its torsion has no exact law: {}; allowed: scenes without a layer "
                                         "that slipstick solve answers with --set solver.model=\"exact\"",
                                         reason));
  }
  const bool is_sphere = scene.surfaces.front().shape == solver::Shape::sphere;
  return {.name = scene.name,
          .profile = answer.oracle->friction.bound,
          .units = LawUnits{.friction = scene.contact.friction.is_coulomb()
                                            ? scene.contact.friction.coefficient
                                            : answer.oracle->friction.force / *unloaded.steps.front().normal,
                            .normal_load = *unloaded.steps.front().normal,
                            .contact_radius = answer.oracle->contact_radius,
                            .shear_modulus = combined_shear_modulus(scene),
                            .sphere_radius = is_sphere ? std::optional(scene.surfaces.front().radius) : std::nullopt}};
}

}  // namespace slipstick::convergence
