#include "convergence/check/loops/loop_contact.hpp"

#include <cmath>
#include <limits>

#include "analytic/cattaneo_mindlin.hpp"
#include "analytic/named_profile.hpp"
#include "analytic/paper_equations.hpp"
#include "convergence/laws/twist_law.hpp"
#include "convergence/oracle/exact_shapes.hpp"
#include "convergence/oracle/law_contact.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

/// Relative error of the polynomials for the exact law: slip at 1e-5 of the limit takes 3e-6 of the moment.
constexpr double kLawError = 1e-10;
/// The same for profiles whose polynomials do not reach that.
constexpr double kRoughLawError = 1e-5;

TwistLaw twist_law(const analytic::Profile& profile) {
  try {
    return fit_twist_law(profile, kLawError);
  } catch (const std::domain_error&) {
    return fit_twist_law(profile, kRoughLawError);
  }
}

/// Profiles that a program may confuse, and the exponents of their gaps.
struct OtherProfile {
  const char* name;
  const char* key;
  double gap;
};
const std::vector<OtherProfile> kProfiles{
    {"a sphere", "hertz", 2.0},
    {"a cone", "cone", 1.0},
    {"a flat punch", "flat_punch", std::numeric_limits<double>::infinity()}};

LoadingCurve force_law(double gap) {
  const auto indenter = std::make_shared<const analytic::SelfSimilarIndenter>(gap);
  return [indenter](double t) {
    constexpr double kSlides = 1.0 - 1e-12;
    const double power = indenter->radius_power();  // 1/(n + 1)
    const double largest = 0.25 / (1.0 - power);    // (n + 1)/(4 n)
    const double size = std::abs(t);
    if (size >= kSlides * largest) return std::copysign(1.0, t);
    return std::copysign(analytic::tangential::from_displacement(size, *indenter).force_ratio, t);
  };
}

solver::Scene under(const solver::Scene& scene, double normal_load) {
  solver::Scene other = scene;
  other.steps.front().normal = normal_load;
  return other;
}

/// d ln(contact radius)/d ln(normal load).
double radius_exponent(const solver::Scene& scene, const LawUnits& units) {
  constexpr double kMore = 1.001;
  const double larger = law_contact(under(scene, kMore * units.normal_load)).units->contact_radius;
  return std::log(larger / units.contact_radius) / std::log(kMore);
}

double exponent_of_gap(const solver::Scene& scene) {
  const std::optional<ExactShape> shape = exact_shape(scene.surfaces.front());
  if (shape && shape->gap_exponent) return *shape->gap_exponent;
  throw solver::InputError(scene.source.string(),
                           "its contact does not stay similar to itself as the load changes: there is no law "
                           "of forces; allowed: sphere, cone, flat_punch, power");
}

}  // namespace

LoopContact torsion_contact(const solver::Scene& scene, double normal_load) {
  const solver::Scene loaded = under(scene, normal_load);
  const LawContact contact = law_contact(loaded);
  const double exponent = radius_exponent(loaded, *contact.units);
  const TwistLaw law = twist_law(*contact.profile);
  std::vector<NamedLoading> others;
  for (const OtherProfile& each : kProfiles) {
    if (each.key == contact.profile->name()) continue;
    others.push_back(
        {each.name, [other = twist_law(*analytic::find_profile(each.key).profile), limit = law.moment_limit](
                        double t) { return other.moment_ratio_at(t) * other.moment_limit / limit; }});
  }
  const auto compliance = [](const solver::Material& body) {
    return (1.0 + body.poisson_ratio) / body.young_modulus;
  };
  const double pair = compliance(scene.upper) + compliance(scene.lower);
  const bool is_sphere = contact.profile->name() == "hertz";
  return {.loading = [law](double t) { return law.moment_ratio_at(t); },
          .stiffness = kStiffness / law.moment_limit,
          .normal_load = normal_load,
          .limit = law.moment_limit * contact.units->moment(),
          .motion_unit = contact.units->rotation(),
          .limit_exponent = 1.0 + exponent,
          .stiffness_exponent = 3.0 * exponent,
          .one_body_upper = pair / compliance(scene.upper),
          .one_body_lower = pair / compliance(scene.lower),
          .uniform_pressure_limit = analytic::dem_moment_limit() / law.moment_limit,
          .sphere_limit = is_sphere ? std::optional(law.moment_limit) : std::nullopt,
          .other_profiles = others,
          .law_error = law.error,
          .words = {"moment", "rotation", "mrad/s"}};
}

LoopContact force_contact(const solver::Scene& scene, double normal_load) {
  const solver::Scene loaded = under(scene, normal_load);
  const LawUnits units = law_contact(loaded).units.value();
  const double gap = exponent_of_gap(scene);
  std::vector<NamedLoading> others;
  for (const OtherProfile& other : kProfiles) {
    if (other.gap != gap && !std::isinf(other.gap)) others.push_back({other.name, force_law(other.gap)});
  }
  const auto compliance = [](const solver::Material& body) {  // (2 - nu)/(2 G)
    return (2.0 - body.poisson_ratio) * (1.0 + body.poisson_ratio) / body.young_modulus;
  };
  const double pair = compliance(scene.upper) + compliance(scene.lower);
  constexpr double kRestStiffness = 4.0;  // dF/ddelta over G_t a
  return {.loading = force_law(gap),
          .stiffness = kRestStiffness,
          .normal_load = normal_load,
          .limit = units.friction * normal_load,
          .motion_unit = units.friction * normal_load * pair / units.contact_radius,
          .limit_exponent = 1.0,
          .stiffness_exponent = radius_exponent(loaded, units),
          .one_body_upper = pair / compliance(scene.upper),
          .one_body_lower = pair / compliance(scene.lower),
          .uniform_pressure_limit = {},
          .sphere_limit = {},
          .other_profiles = others,
          .law_error = kLawError,
          .words = {"force", "displacement", "mm/s"}};
}

}  // namespace slipstick::convergence
