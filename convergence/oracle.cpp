#include "convergence/oracle.hpp"

#include <fmt/core.h>

#include <cmath>
#include <stdexcept>

#include "analytic/indentation.hpp"

namespace slipstick::convergence {
namespace {

/// Why the theory does not hold for a scene; empty if it does.
std::string obstacle(const solver::Scene& scene) {
  using solver::Shape;
  if (scene.surface.shape != Shape::sphere) {
    return fmt::format("no exact solution is known here for shape = \"{}\"", to_string(scene.surface.shape));
  }
  if (scene.pressure == solver::PressureModel::file) return "the pressure comes from a file";
  if (!(scene.friction > 0.0)) return "without friction there is no traction to compare";
  const auto mismatch = [](const solver::Material& m) {
    return (1.0 - 2.0 * m.poisson_ratio) * (1.0 + m.poisson_ratio) / m.young_modulus;
  };
  if (scene.coupling != solver::Coupling::none && mismatch(scene.upper) != mismatch(scene.lower)) {
    return "the pressure's tangential displacement of dissimilar materials enters (contact.coupling)";
  }
  return "";
}

analytic::TorsionState state_under(const solver::TorsionLoad& load, double moment_limit, double twist_unit) {
  if (load.twist) return analytic::from_twist(*load.twist / twist_unit);
  return analytic::from_moment_ratio(load.moment_ratio ? *load.moment_ratio : *load.moment / moment_limit);
}

}  // namespace

double Oracle::pressure(double radius) const {
  const double ratio = radius / contact_radius;
  return ratio < 1.0 ? peak_pressure * std::sqrt((1.0 - ratio) * (1.0 + ratio)) : 0.0;
}

double Oracle::traction(double radius) const {
  const double ratio = radius / contact_radius;
  return ratio < 1.0 ? friction * peak_pressure * analytic::traction(state, ratio) : 0.0;
}

OracleAnswer find_oracle(const solver::Scene& scene) {
  const std::string reason = obstacle(scene);
  if (!reason.empty()) return {std::nullopt, reason};

  const auto sum_of = [&](auto numerator) {
    return numerator(scene.upper.poisson_ratio) / scene.upper.young_modulus +
           numerator(scene.lower.poisson_ratio) / scene.lower.young_modulus;
  };
  const double effective_modulus = 1.0 / sum_of([](double nu) { return 1.0 - nu * nu; });
  const double shear_modulus = 1.0 / sum_of([](double nu) { return 2.0 * (1.0 + nu); });
  const double load = *scene.normal_load;
  const auto hertz = analytic::indent_sphere(load, scene.surface.radius, effective_modulus);
  const double moment_unit = scene.friction * load * hertz.contact_radius;
  const double twist_unit =
      scene.friction * load / (shear_modulus * hertz.contact_radius * hertz.contact_radius);
  const double limit = analytic::hertz_profile().moment_limit() * moment_unit;

  analytic::TorsionState state{};
  try {
    state = state_under(scene.torsion, limit, twist_unit);
  } catch (const std::domain_error& error) {
    return {std::nullopt, fmt::format("beyond the range of the exact solution: {}", error.what())};
  }
  return {Oracle{.contact_radius = hertz.contact_radius,
                 .peak_pressure = hertz.reference_pressure,
                 .approach = hertz.approach,
                 .moment_limit = limit,
                 .moment = state.moment * moment_unit,
                 .twist_angle = state.twist * twist_unit,
                 .stick_radius = state.stick_ratio * hertz.contact_radius,
                 .friction = scene.friction,
                 .state = state},
          ""};
}

}  // namespace slipstick::convergence
