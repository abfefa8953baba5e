#include "convergence/check/examination.hpp"

#include <fmt/core.h>

#include <cmath>
#include <utility>

#include "convergence/check/diagnosis.hpp"
#include "solver/contact/limit_load.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using solver::Index;
using solver::InputError;

void require_judgeable(const solver::Scene& scene) {
  const std::string file = scene.source.string();
  if (scene.steps.size() > 1 || scene.cycles > 1) {
    throw InputError(file, "step",
                     fmt::format("{} steps", scene.steps.size() * static_cast<std::size_t>(scene.cycles)),
                     "a scene of one load: a field does not say what happened in the steps before");
  }
  if (!(scene.friction > 0.0)) {
    throw InputError(file, "contact.friction", fmt::format("{}", scene.friction),
                     "larger than zero: without friction there is no traction to judge");
  }
}

/// The oracle as seen from the middle of the field's grid.
OracleAnswer seen_from(OracleAnswer exact, const std::array<double, 2>& centre) {
  if (!exact.oracle) return exact;
  for (std::size_t k = 0; k < 2; ++k) exact.oracle->centre[k] -= centre[k];
  return exact;
}

/// The exact pressure of a scene, whatever its tangential loads.
OracleAnswer exact_normal_contact(solver::Scene scene) {
  solver::Step& load = scene.steps.front();
  if (!load.normal) return {std::nullopt, "the normal load is not known"};
  constexpr double kAnyRatio = 0.5;
  load.torsion = solver::MomentRatio{kAnyRatio};
  load.force = {};
  load.displacement.reset();
  scene.coupling = solver::Coupling::none;
  return find_oracle(scene);
}

/// M over the cell area that the scene asks for, of this pressure. Under an imposed twist it is an outcome.
std::optional<double> moment_asked_for(const solver::Scene& scene, const OracleAnswer& exact, double limit,
                                       double unit) {
  const solver::TorsionLoad& torsion = scene.steps.front().torsion;
  if (std::holds_alternative<solver::Twist>(torsion)) return std::nullopt;
  if (exact.oracle && std::isfinite(exact.oracle->moment)) return exact.oracle->moment / unit;
  if (const auto moment = solver::value_if<solver::Moment>(torsion)) return *moment / unit;
  return std::get<solver::MomentRatio>(torsion).value * limit;
}

/// Twist in the sense of the moment, in which first loading turns.
std::optional<double> known_twist(const solver::Scene& scene, std::optional<double> given, double moment,
                                  std::vector<std::string>& conventions) {
  if (!given) return solver::value_if<solver::Twist>(scene.steps.front().torsion);
  if (*given * moment >= 0.0) return given;
  conventions.push_back("the twist that was given counts the other way round");
  return -*given;
}

void certify_field(Examination& e) {
  const GivenContact& c = e.contact;
  const solver::Step& load = e.scene.steps.front();
  const std::array<double, 2> asked{load.force[0] / e.newtons(), load.force[1] / e.newtons()};
  e.certificate =
      solver::certify({c.traction, c.elastic_displacement, e.state.slip}, c.friction_bound, c.rotation,
                      e.moment.value_or(c.moment()), load.displacement ? c.force() : asked);
  e.direction = noticeable_direction(c, e.fitted, e.yardstick.mesh.tractions);
}

}  // namespace

Examination examine(const solver::Scene& scene, const std::filesystem::path& file,
                    std::optional<double> given_twist) {
  require_judgeable(scene);
  const solver::Step& load = scene.steps.front();
  const solver::Model scene_model = solver::make_model(scene);
  const OracleAnswer exact = find_oracle(scene);
  Interpretation read = in_own_conventions(read_foreign_field(file), scene, scene_model, exact);
  GivenContact contact = make_given_contact(read.field, scene, scene_model);
  const std::optional<double> twist = known_twist(scene, given_twist, contact.moment(), read.conventions);
  const OracleAnswer pressed = seen_from(exact_normal_contact(scene), read.field.centre);
  Yardstick yardstick = find_yardstick(contact, load, pressed.oracle, given_twist.has_value());
  const bool constant_cells = solves_normal_problem(contact, scene);
  State fitted = find_state(contact, load, std::nullopt);
  State state = twist ? find_state(contact, load, twist) : fitted;
  const Deviation deviation = find_deviation(contact, yardstick.right, given_twist ? state : fitted, fitted);
  Examination e{.scene = scene,
                .read = std::move(read),
                .exact = {},
                .contact = std::move(contact),
                .yardstick = std::move(yardstick),
                .constant_cells = constant_cells,
                .twist_given = twist.has_value(),
                .state = std::move(state),
                .fitted = std::move(fitted),
                .deviation = deviation,
                .stick = {},
                .moment = {},
                .moment_limit = NAN};
  e.exact = seen_from(exact, e.read.field.centre);
  e.stick = stick_cells(e.contact);
  e.moment_limit = solver::free_moment_limit(e.contact.model.grid, e.contact.friction_bound);
  e.moment = moment_asked_for(scene, exact, e.moment_limit, e.newton_metres());
  certify_field(e);
  return e;
}

double relative_error(double value, double exact) { return value / exact - 1.0; }

}  // namespace slipstick::convergence
