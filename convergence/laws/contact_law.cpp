#include "convergence/laws/contact_law.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "analytic/approximations.hpp"
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

template <class Function>
auto naming(const char* option, Function function) {
  try {
    return function();
  } catch (const std::domain_error& error) {
    throw std::domain_error(fmt::format("{}: {}", option, error.what()));
  }
}

/// The largest distance between a spring with a cap and the curve: where the curve has the spring's slope, or
/// where the spring reaches its cap.
SpringAndCap with_stiffness(double stiffness, const analytic::Profile& profile) {
  const double rest = kStiffness / profile.moment_limit();
  const double part = std::min(1.0, stiffness / rest);
  const auto touching = analytic::from_stick_ratio(std::cbrt(part), profile);
  const double below = touching.moment_ratio - stiffness * touching.twist;
  const double above = analytic::from_twist(1.0 / stiffness, profile).moment_deficit;
  return {stiffness, std::max(below, above)};
}

SpringAndCap best_spring(const analytic::Profile& profile) {
  double low = 0.1 * kStiffness / profile.moment_limit();
  double high = kStiffness / profile.moment_limit();
  constexpr int kHalvings = 50;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    const double above = analytic::from_twist(1.0 / middle, profile).moment_deficit;
    (with_stiffness(middle, profile).error > above ? low : high) = middle;
  }
  return with_stiffness(0.5 * (low + high), profile);
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
                                         "that slipstick solve answers with "
                                         "--set solver.model=\"exact\"",
                                         reason));
  }
  const bool is_sphere = scene.surfaces.front().shape == solver::Shape::sphere;
  return {.name = scene.name,
          .profile = answer.oracle->friction.bound,
          .units = LawUnits{
              .friction = scene.contact.friction.is_coulomb()
                              ? scene.contact.friction.coefficient
                              : answer.oracle->friction.force / *unloaded.steps.front().normal,
              .normal_load = *unloaded.steps.front().normal,
              .contact_radius = answer.oracle->contact_radius,
              .shear_modulus = combined_shear_modulus(scene),
              .sphere_radius = is_sphere ? std::optional(scene.surfaces.front().radius) : std::nullopt}};
}

ContactLaw make_contact_law(const LawContact& contact, const LawOptions& options) {
  const analytic::Profile& profile = *contact.profile;
  return {
      .contact = contact,
      .law = naming("--error", [&] { return fit_twist_law(profile, options.error); }),
      .table = naming("--table-error", [&] { return tabulate(profile, options.table_error); }),
      .elements =
          options.elements
              ? naming("--elements", [&] { return parallel_elements(profile, *options.elements); })
              : naming("--element-error", [&] { return parallel_elements(profile, options.element_error); }),
      .limit = naming("--limit-loads", [&] { return limit_surface(profile, options.limit_loads); }),
      .rest_spring = with_stiffness(kStiffness / profile.moment_limit(), profile),
      .best_spring = best_spring(profile)};
}

double uniform_pressure_cap_error(const analytic::Profile& profile) {
  return analytic::dem_moment_limit() / profile.moment_limit() - 1.0;
}

}  // namespace slipstick::convergence
