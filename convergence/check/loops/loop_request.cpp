#include "convergence/check/loops/loop_request.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "analytic/axisymmetric.hpp"
#include "convergence/check/loops/loop_record.hpp"
#include "convergence/oracle/exact_theories.hpp"
#include "convergence/oracle/law_contact.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

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

double gap_exponent(const solver::Scene& scene) {
  const std::optional<ExactShape> shape = exact_shape(scene.surfaces.front());
  if (shape && shape->gap_exponent) return *shape->gap_exponent;
  throw solver::InputError(scene.source.string(),
                           "its contact does not stay similar to itself as the load changes: there is no law "
                           "of forces; allowed: sphere, cone, flat_punch, power");
}

/// The contact under a normal load, with the numbers of both kinds of loops: the load's unit is the limit,
/// and the motion's mu W/(G a^2) in torsion; under a force mu W/(G_t a), with 1/G_t = sum of (2 - nu)/(2 G).
/// one_body: the stiffness with the other body rigid, over the pair's. A force has Cattaneo's and Mindlin's
/// law, which is exact for Poisson's ratios of 0 and otherwise neglects slip across the force.
Json contact_json(const solver::Scene& scene, double normal_load, bool of_force) {
  const solver::Scene loaded = under(scene, normal_load);
  const LawContact contact = law_contact(loaded);
  const LawUnits& units = *contact.units;
  const auto compliance = [&](const solver::Material& body) {
    const double shear = (1.0 + body.poisson_ratio) / body.young_modulus;
    return of_force ? (2.0 - body.poisson_ratio) * shear : shear;
  };
  const double pair = compliance(scene.upper) + compliance(scene.lower);
  Json json{{"normal_load", normal_load},
            {"radius_exponent", radius_exponent(loaded, units)},
            {"one_body", {pair / compliance(scene.upper), pair / compliance(scene.lower)}}};
  if (of_force) {
    const double limit = units.friction * normal_load;
    json.update({{"limit", limit},
                 {"motion_unit", limit * pair / units.contact_radius},
                 {"gap", gap_exponent(scene)}});
    return json;
  }
  json.update({{"limit", contact.profile->moment_limit() * units.moment()},
               {"motion_unit", units.rotation()},
               {"profile", contact.profile->name()}});
  return json;
}

}  // namespace

Json loop_request(const solver::Scene& scene, const std::filesystem::path& file, const LoopOptions& options) {
  law_contact(scene);  // or why there is none, before the loop is read
  const LoopRecord record = read_loop(file);
  Json groups = Json::array();
  for (const LoadRows& group : rows_by_load(record, *scene.steps.front().normal)) {
    Json& json = groups.emplace_back(contact_json(scene, group.normal_load, record.of_force));
    json["rows"] = {group.from, group.to};
  }
  return {{"name", scene.name},
          {"loop", file.string()},
          {"of_force", record.of_force},
          {"tolerance", options.tolerance},
          {"strict", options.strict},
          {"time", record.time},
          {"load", record.load},
          {"motion", record.motion},
          {"groups", groups}};
}

}  // namespace slipstick::convergence
