#include "convergence/oracle.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "analytic/indentation.hpp"

namespace slipstick::convergence {
namespace {

bool axisymmetric(const solver::Surface& surface) {
  using solver::Shape;
  if (surface.shape == Shape::ellipsoid) return surface.radius_1 == surface.radius_2;
  return surface.shape != Shape::height_map;
}

/// Why the theory does not hold for a scene; empty if it does.
std::string obstacle(const solver::Scene& scene) {
  const solver::Surface& surface = scene.surface;
  if (!axisymmetric(surface)) {
    const bool ellipsoid = surface.shape == solver::Shape::ellipsoid;
    return fmt::format("no exact solution is known here for shape = \"{}\"{}", to_string(surface.shape),
                       ellipsoid ? " with two different radii" : "");
  }
  if (scene.pressure == solver::PressureModel::file) return "the pressure comes from a file";
  if (!(scene.friction > 0.0)) return "without friction there is no traction";
  const auto mismatch = [](const solver::Material& m) {
    return (1.0 - 2.0 * m.poisson_ratio) * (1.0 + m.poisson_ratio) / m.young_modulus;
  };
  if (scene.coupling != solver::Coupling::none && mismatch(scene.upper) != mismatch(scene.lower)) {
    return "the pressure's tangential displacement of dissimilar materials enters (contact.coupling)";
  }
  return "";
}

/// Moduli of the pair: 1/E* = sum of (1 - nu^2)/E, and 1/G = sum of 2 (1 + nu)/E.
struct Moduli {
  double effective;
  double shear;
};
Moduli moduli(const solver::Scene& scene) {
  const auto sum_of = [&](auto numerator) {
    return numerator(scene.upper.poisson_ratio) / scene.upper.young_modulus +
           numerator(scene.lower.poisson_ratio) / scene.lower.young_modulus;
  };
  return {.effective = 1.0 / sum_of([](double nu) { return 1.0 - nu * nu; }),
          .shear = 1.0 / sum_of([](double nu) { return 2.0 * (1.0 + nu); })};
}

/// The contact before torsion.
struct NormalContact {
  const analytic::Profile& profile;
  analytic::Indentation indentation;
};
NormalContact press(const solver::Surface& surface, double load, double effective_modulus) {
  using solver::Shape;
  switch (surface.shape) {
    case Shape::sphere:
      return {analytic::hertz_profile(), analytic::indent_sphere(load, surface.radius, effective_modulus)};
    case Shape::ellipsoid:  // of equal radii
      return {analytic::hertz_profile(), analytic::indent_sphere(load, surface.radius_1, effective_modulus)};
    case Shape::cone:
      return {analytic::cone_profile(), analytic::indent_cone(load, surface.slope, effective_modulus)};
    case Shape::flat_punch:
      return {analytic::flat_punch_profile(),
              analytic::indent_flat_punch(load, surface.radius, effective_modulus)};
    case Shape::height_map:
      break;
  }
  throw std::logic_error("a shape without an exact solution");
}

/// What makes dimensionless moments and twists those of the scene.
struct TorsionUnits {
  double moment;  ///< mu W a
  double twist;   ///< mu W/(G a^2)
};

analytic::TorsionState state_under(const solver::TorsionLoad& load, const analytic::Profile& profile,
                                   const TorsionUnits& units) {
  if (load.twist) return analytic::from_twist(*load.twist / units.twist, profile);
  const double limit = profile.moment_limit() * units.moment;
  return analytic::from_moment_ratio(load.moment_ratio ? *load.moment_ratio : *load.moment / limit, profile);
}

}  // namespace

double Oracle::pressure(double radius) const {
  const double ratio = radius / contact_radius;
  return ratio < 1.0 ? reference_pressure * profile->pressure(ratio) : 0.0;
}

double Oracle::traction(double radius) const {
  const double ratio = radius / contact_radius;
  return ratio < 1.0 ? friction * reference_pressure * analytic::traction(state, ratio, *profile) : 0.0;
}

OracleAnswer find_oracle(const solver::Scene& scene) {
  const std::string reason = obstacle(scene);
  if (!reason.empty()) return {std::nullopt, reason};

  const Moduli pair = moduli(scene);
  const double load = *scene.normal_load;
  const auto [profile, contact] = press(scene.surface, load, pair.effective);
  const double a = contact.contact_radius;
  const TorsionUnits units{.moment = scene.friction * load * a,
                           .twist = scene.friction * load / (pair.shear * a * a)};
  const double limit = profile.moment_limit() * units.moment;

  analytic::TorsionState state{};
  try {
    state = state_under(scene.torsion, profile, units);
  } catch (const std::domain_error& error) {
    return {std::nullopt,
            fmt::format(
                "beyond the range of the exact solution: {} (M_lim = {:.17g} N m, mu W/(G a^2) = {:.6g} rad)",
                error.what(), limit, units.twist),
            true};
  }
  // Every profile's pressure is highest on the axis or at the edge.
  const double peak = std::max(profile.pressure(0.0), profile.pressure(1.0));
  return {Oracle{.profile = &profile,
                 .contact_radius = a,
                 .reference_pressure = contact.reference_pressure,
                 .peak_pressure = contact.reference_pressure * peak,
                 .approach = contact.approach,
                 .moment_limit = limit,
                 .moment = state.moment * units.moment,
                 .twist_angle = state.twist * units.twist,
                 .stick_radius = state.stick_ratio * a,
                 .friction = scene.friction,
                 .state = state},
          ""};
}

}  // namespace slipstick::convergence
