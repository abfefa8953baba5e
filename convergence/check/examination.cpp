#include "convergence/check/examination.hpp"

#include <fmt/core.h>

#include <cmath>

#include "convergence/check/diagnosis.hpp"
#include "solver/contact/limit_load.hpp"
#include "solver/input/input_error.hpp"
#include "solver/model/make_model.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using solver::Index;
using solver::InputError;

/// Error of a pressure of constant cells, over the error of other right pressures.
constexpr double kConstantCells = 0.1;

void require_judgeable(const solver::Scene& scene) {
  const std::string file = scene.source.string();
  if (scene.steps.size() > 1 || scene.cycles > 1) {
    throw InputError(file, "step",
                     fmt::format("{} steps", scene.steps.size() * static_cast<std::size_t>(scene.cycles)),
                     "a scene of one load: a field does not say what happened in the steps before");
  }
  if (scene.friction.is_frictionless()) {
    throw InputError(file, "contact.friction", fmt::format("{}", scene.friction.coefficient),
                     "larger than zero: without friction there is no traction to judge");
  }
}

/// The same answer with positions about `centre`.
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
  scene.friction = 1.0;
  return find_oracle(scene);
}

/// Whether a twist differs from the one that fits the tractions in its sign, and is more than rounding.
bool is_turned_over(const GivenContact& c, double twist, double fitted) {
  constexpr double kSameSize = 0.1;        // relative
  constexpr double kSmallestTwist = 1e-6;  // over the largest displacement
  return std::abs(twist + fitted) < kSameSize * std::abs(twist) &&
         std::abs(twist) * solver::norms(c.rotation).maxCoeff() >
             kSmallestTwist * solver::norms(c.displacement).maxCoeff();
}

/// The certificate under the loads that the scene asks for, otherwise under the field's own.
solver::Certificate certify_field(const GivenContact& c, const solver::Step& load, const State& state,
                                  const std::optional<double>& moment) {
  const std::array<double, 2> asked{load.force[0] / c.newtons(), load.force[1] / c.newtons()};
  return solver::certify({c.traction, c.elastic_displacement, state.slip}, c.friction_bound, c.rotation,
                         moment.value_or(c.moment()), load.displacement ? c.force() : asked);
}

}  // namespace

Examination examine(const solver::Scene& scene, const std::filesystem::path& file,
                    std::optional<double> given_twist, bool pressure_given,
                    const std::vector<std::string>& columns) {
  require_judgeable(scene);
  const solver::Step& load = scene.steps.front();
  const solver::Model model = solver::make_model(scene);
  const OracleAnswer exact = find_oracle(scene);
  Interpretation read = in_own_conventions(read_foreign_field(file, columns), scene, model, exact);
  const GivenContact contact = make_given_contact(read.field, model, model.threads);

  const State fitted = find_state(contact, load, std::nullopt);
  std::optional<double> twist = given_twist;
  if (!twist) {
    twist = solver::value_if<solver::Twist>(load.torsion);
  } else if (is_turned_over(contact, *twist, fitted.twist)) {
    twist = -*twist;
    read.conventions.emplace_back("the twist that was given counts the other way round");
  }
  const OracleAnswer pressed = seen_from(exact_normal_contact(scene), read.field.centre);
  const ReferenceOnGrid reference = find_reference_on_grid(
      contact, scene, model,
      {pressed.oracle, seen_from(exact, read.field.centre).oracle, given_twist.has_value(), pressure_given});
  const State state = twist ? find_state(contact, load, twist) : fitted;
  const double limit = solver::free_moment_limit(contact.grid, contact.friction_bound);
  const auto moment = std::holds_alternative<solver::Twist>(load.torsion)
                          ? std::nullopt
                          : known_moment(scene, exact, limit, contact.newton_metres());
  return {.scene = scene,
          .read = read,
          .exact = seen_from(exact, read.field.centre),
          .contact = contact,
          .reference = reference,
          .constant_cells = reference.pressure &&
                            reference.pressure->off <= kConstantCells * reference.mesh.deviation.pressure,
          .pressure_given = pressure_given,
          .twist_given = twist.has_value(),
          .state = state,
          .fitted = fitted,
          .deviation = find_deviation(contact, reference.right, given_twist ? state : fitted, fitted,
                                      reference.regions),
          .stick = stick_cells(contact),
          .moment = moment,
          .moment_limit = limit,
          .certificate = certify_field(contact, load, state, moment),
          .direction = noticeable_direction(contact, fitted, reference.mesh.deviation.tractions)};
}

double relative_error(double value, double exact) { return value / exact - 1.0; }

}  // namespace slipstick::convergence
