
#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "convergence/results/provenance.hpp"
#include "interfaces/laws/law_files.hpp"

namespace slipstick::laws {

using namespace convergence;

namespace {

Json fit_json(const PiecewiseChebyshev& fit) {
  Json pieces = Json::array();
  for (const ChebyshevPiece& piece : fit.pieces)
    pieces.push_back({{"low", piece.low}, {"high", piece.high}, {"coefficients", piece.coefficients}});
  return {{"error_found", fit.error}, {"degree", fit.degree()}, {"pieces", pieces}};
}

Json units_json(const LawContact& contact) {
  if (!contact.units) {
    return {{"rotation", "mu W/(G a^2)"}, {"moment", "mu W a"}, {"rotation_unit", 1.0}, {"moment_unit", 1.0}};
  }
  return {{"rotation", "rad"},
          {"moment", "N m"},
          {"rotation_unit", contact.units->rotation()},
          {"moment_unit", contact.units->moment()},
          {"friction", contact.units->friction},
          {"normal_load", contact.units->normal_load},
          {"contact_radius", contact.units->contact_radius},
          {"shear_modulus", contact.units->shear_modulus}};
}

Json table_json(const ContactLaw& law) {
  std::vector<double> rotation;
  std::vector<double> moment;
  for (const analytic::TorsionState& state : law.table.rows) {
    rotation.push_back(state.twist * law.rotation_unit());
    moment.push_back(state.moment * law.moment_unit());
  }
  return {{"error", law.table.error}, {"rotation", rotation}, {"moment", moment}};
}

Json elements_json(const ContactLaw& law) {
  std::vector<double> stiffness;
  std::vector<double> slip_moment;
  for (const JenkinsElement& element : law.elements.elements) {
    stiffness.push_back(element.stiffness * law.limit_moment() / law.rotation_unit());
    slip_moment.push_back(element.slip * law.limit_moment());
  }
  return {{"error", law.elements.error},
          {"loop_error", 3.0 * law.elements.error},
          {"history_error", law.elements.history_error},
          {"stiffness", stiffness},
          {"slip_moment", slip_moment}};
}

Json limit_json(const ContactLaw& law) {
  const double force = law.contact.units ? law.contact.units->friction * law.contact.units->normal_load : 1.0;
  const double length = law.contact.units ? law.contact.units->contact_radius : 1.0;
  const auto load_json = [&](const LimitLoad& load) {
    Json json{{"force", load.force * force}, {"moment", load.moment * law.limit_moment()}};
    set_number(json, "centre", load.centre * length, "it slides without turning");
    return json;
  };
  Json loads = Json::array();
  for (const LimitLoad& load : law.limit.loads) loads.push_back(load_json(load));
  return {
      {"gap", law.limit.gap},
      {"loads", loads},
      {"ellipsoid", {{"error", law.limit.ellipsoid_error}, {"at", load_json(law.limit.ellipsoid_farthest)}}}};
}

Json programs_json(const ContactLaw& law) {
  const LammpsTwisting lammps = lammps_twisting(law);
  Json json{{"lammps",
             {{"k_twist", lammps.stiffness},
              {"mu_twist", lammps.arm},
              {"error", lammps.error},
              {"error_with_stiffness_at_rest", law.rest_spring.error},
              {"marshall_limit_error", lammps.marshall_cap_error}}}};
  if (const auto mujoco = mujoco_friction(law)) {
    json.update({{"mujoco",
                  {{"friction", {mujoco->sliding, mujoco->torsional, 0.0}},
                   {"lost_presliding", mujoco->lost_presliding},
                   {"combined_error", mujoco->combined_error}}}});
  } else {
    set_missing(json, "mujoco", "its friction has a length: give a scene");
  }
  if (const auto drake = drake_hydroelastic(law)) {
    json.update({{"drake",
                  {{"mu_dynamic", drake->mu_dynamic},
                   {"hydroelastic_modulus", drake->modulus},
                   {"contact_radius", drake->contact_radius},
                   {"half_load_error", drake->half_load_error},
                   {"lost_presliding", drake->lost_presliding}}}});
  } else {
    set_missing(json, "drake", "its modulus needs a sphere: give the scene of a sphere");
  }
  return json;
}

std::string percent(double value) { return fmt::format("{:+.2g} %", 100.0 * value); }

}  // namespace

Json law_json(const ContactLaw& law) {
  return {{"name", law.contact.name},
          {"profile", law.contact.profile->name()},
          {"units", units_json(law.contact)},
          {"stiffness", kStiffness * law.moment_unit() / law.rotation_unit()},
          {"moment_limit", law.limit_moment()},
          {"full_stick", law.law.full_stick},
          {"fit",
           {{"error", law.law.error},
            {"last_deficit", kLastDeficit},
            {"last_twist", law.law.last_twist},
            {"logarithm_per_twist", fit_json(law.law.logarithm)},
            {"twist_per_logarithm", fit_json(law.law.twist)},
            {"first_logarithm", law.law.first_logarithm},
            {"loss_power", law.law.loss_power},
            {"loss_factor", fit_json(law.law.loss_factor)}}},
          {"table", table_json(law)},
          {"elements", elements_json(law)},
          {"limit_surface", limit_json(law)},
          {"programs", programs_json(law)},
          {"provenance", provenance(1)}};
}

std::string law_text(const ContactLaw& law) {
  const bool in_si = law.contact.units.has_value();
  const TwistLaw& fit = law.law;
  const ParallelElements& elements = law.elements;
  const LammpsTwisting lammps = lammps_twisting(law);
  std::string text =
      fmt::format("{}: law of torsion, profile {}\n", law.contact.name, law.contact.profile->name()) +
      text_line("stiffness",
                fmt::format("{:.6g} {}, at rest", kStiffness * law.moment_unit() / law.rotation_unit(),
                            in_si ? "N m/rad" : "G a^3")) +
      text_line("limit", fmt::format("{:.6g} {}", law.limit_moment(), in_si ? "N m" : "mu W a")) +
      text_line("fit", fmt::format("{} + {} + {} pieces for moment, rotation, loss: within {:.0e}; found "
                                   "{:.1e}, {:.1e}, {:.1e}",
                                   fit.logarithm.pieces.size(), fit.twist.pieces.size(),
                                   fit.loss_factor.pieces.size(), fit.error, fit.logarithm.error,
                                   fit.twist.error, fit.loss_factor.error)) +
      text_line("table", fmt::format("{} rows, straight lines in between: within {:.2g} of the limit",
                                     law.table.rows.size(), law.table.error)) +
      text_line("elements",
                fmt::format("{} in parallel: within {:.2g} of the limit on first loading, {:.2g} on "
                            "loops between t and -t, {:.2g} after any rotations",
                            elements.elements.size(), elements.error, 3.0 * elements.error,
                            elements.history_error)) +
      text_line("limit surface", fmt::format("{} loads; the ellipsoid through its ends is {} off",
                                             law.limit.loads.size(), percent(law.limit.ellipsoid_error))) +
      text_line("LAMMPS", fmt::format("twisting sds {:.6g} 0 {:.6g}: up to {} of the limit off; twisting "
                                      "marshall: the limit {}",
                                      lammps.stiffness, lammps.arm, percent(lammps.error),
                                      percent(lammps.marshall_cap_error)));
  if (const auto mujoco = mujoco_friction(law)) {
    text += text_line(
        "MuJoCo", fmt::format("friction {:.6g} {:.6g} 0: the limit exact, no presliding ({:.6g} rad at 0.9)",
                              mujoco->sliding, mujoco->torsional, mujoco->lost_presliding));
  }
  if (const auto drake = drake_hydroelastic(law)) {
    text += text_line(
        "Drake", fmt::format("hydroelastic_modulus {:.6g}: the limit exact at this load, {} at half of it",
                             drake->modulus, percent(drake->half_load_error)));
  }
  return text;
}

}  // namespace slipstick::laws
