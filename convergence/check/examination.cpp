#include "convergence/check/examination.hpp"

#include <fmt/core.h>

#include <cmath>
#include <utility>

#include "convergence/check/conventions.hpp"
#include "convergence/check/diagnosis.hpp"
#include "convergence/check/fitted_motion.hpp"
#include "solver/input_error.hpp"
#include "solver/limit_load.hpp"

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

/// M over the cell area that the scene asks for, of this pressure.
std::optional<double> moment_asked_for(const solver::Scene& scene, const OracleAnswer& exact, double limit,
                                       double unit) {
  const solver::TorsionLoad& torsion = scene.steps.front().torsion;
  if (exact.oracle && std::isfinite(exact.oracle->moment)) return exact.oracle->moment / unit;
  if (torsion.moment) return *torsion.moment / unit;
  if (torsion.moment_ratio) return *torsion.moment_ratio * limit;
  return std::nullopt;
}

/// Twist in the sense of the moment, in which first loading turns.
std::optional<double> known_twist(const solver::Scene& scene, std::optional<double> given, double moment,
                                  std::vector<std::string>& notes) {
  if (!given) return scene.steps.front().torsion.twist;
  if (*given * moment >= 0.0) return given;
  notes.push_back("the twist that was given counts the other way round");
  return -*given;
}

void set_motion(Examination& e, std::optional<double> twist) {
  const solver::Step& load = e.scene.steps.front();
  const GivenContact& c = e.contact;
  // Where |q| exceeds its bound the gap would not be one.
  const ArrayXd bound =
      c.friction_bound.max(solver::norms(c.traction) * (c.friction_bound > 0.0).cast<double>());
  const auto fit = [&](std::optional<double> imposed) {
    const RigidMotions motions = rigid_motions(c, load, imposed);
    return fit_motion(c.displacement - motions.imposed, c.traction, bound, motions.free);
  };
  const FittedMotion inferred = fit({});
  e.inferred_twist = inferred.coefficients[inferred.coefficients.size() - 1];
  const FittedMotion fitted = twist ? fit(twist) : inferred;
  e.twist_given = twist.has_value();
  e.twist = twist.value_or(e.inferred_twist);
  for (std::size_t k = 0; k < 2; ++k) {
    e.displacement[k] = load.displacement ? (*load.displacement)[k] / c.model.length_unit
                                          : fitted.coefficients[static_cast<Index>(k)];
  }
  e.slip = fitted.slip;
  e.gap = fitted.gap;
}

/// Slip that is more than what the mesh leaves open of the displacements (in sticking cells the rest has any
/// direction), in cells that carry something.
ArrayXd noticeable_slip(const Examination& e) {
  const GivenContact& c = e.contact;
  const double least = e.yardstick.mesh_error * solver::norms(c.displacement).maxCoeff();
  const ArrayXd size = solver::norms(e.slip);
  const double something = kNextToNothing * c.friction_bound.maxCoeff();
  const ArrayXd noticeable = ((size > least) && (c.friction_bound > something)).cast<double>();
  return noticeable.replicate(2, 1) * e.slip;
}

void certify_field(Examination& e) {
  const GivenContact& c = e.contact;
  const solver::Step& load = e.scene.steps.front();
  const std::array<double, 2> asked{load.force[0] / e.newtons(), load.force[1] / e.newtons()};
  e.certificate = solver::certify({c.traction, c.elastic_displacement, e.slip}, c.friction_bound, c.rotation,
                                  e.moment.value_or(c.moment()), load.displacement ? c.force() : asked);
  e.direction = solver::slip_direction(c.traction, noticeable_slip(e));
}

}  // namespace

Examination examine(const solver::Scene& scene, const std::filesystem::path& file,
                    std::optional<double> twist) {
  require_judgeable(scene);
  const solver::Model scene_model = solver::make_model(scene);
  const OracleAnswer exact = find_oracle(scene);
  ForeignField field = in_own_conventions(read_foreign_field(file), scene, scene_model, exact);
  Examination e{.scene = scene,
                .field = std::move(field),
                .exact = {},
                .contact = {},
                .yardstick = {},
                .twist_given = false,
                .twist = NAN,
                .inferred_twist = NAN,
                .slip = {},
                .gap = {},
                .stick = {},
                .moment = {},
                .moment_limit = NAN};
  e.exact = seen_from(exact, e.field.centre);
  e.contact = make_given_contact(e.field, scene, scene_model);
  e.yardstick = find_yardstick(e.contact);
  e.moment_limit = solver::free_moment_limit(e.contact.model.grid, e.contact.friction_bound);
  e.moment = moment_asked_for(scene, exact, e.moment_limit, e.newton_metres());
  set_motion(e, known_twist(scene, twist, e.contact.moment(), e.field.notes));
  e.stick = stick_cells(e.contact);
  certify_field(e);
  return e;
}

double relative_error(double value, double exact) { return value / exact - 1.0; }

}  // namespace slipstick::convergence
