
#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "convergence/results/provenance.hpp"
#include "interfaces/laws/law_files.hpp"

namespace slipstick::laws {

using namespace convergence;

namespace {

Json fit_json(const PiecewiseChebyshev& fit) {
  Json json{{"error_found", fit.error}, {"degree", fit.degree()}};
  for (const ChebyshevPiece& piece : fit.pieces) {
    json["pieces"].push_back(
        {{"low", piece.low}, {"high", piece.high}, {"coefficients", piece.coefficients}});
  }
  return json;
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
  Json json{{"error", law.table.error}};
  for (const analytic::TorsionState& state : law.table.rows) {
    json["rotation"].push_back(state.twist * law.rotation_unit());
    json["moment"].push_back(state.moment * law.moment_unit());
  }
  return json;
}

Json elements_json(const ContactLaw& law) {
  Json json{{"error", law.elements.error},
            {"loop_error", 3.0 * law.elements.error},
            {"history_error", law.elements.history_error}};
  for (const auto& [stiffness, slip] : law.elements.elements) {
    json["stiffness"].push_back(stiffness * law.limit_moment() / law.rotation_unit());
    json["slip_moment"].push_back(slip * law.limit_moment());
  }
  return json;
}

Json limit_json(const ContactLaw& law) {
  const double force = law.contact.units ? law.contact.units->friction * law.contact.units->normal_load : 1.0;
  const double length = law.contact.units ? law.contact.units->contact_radius : 1.0;
  const auto load_json = [&](const LimitLoad& load) {
    Json json{{"force", load.force * force}, {"moment", load.moment * law.limit_moment()}};
    set_number(json, "centre", load.centre * length, "it slides without turning");
    return json;
  };
  Json json{{"gap", law.limit.gap}};
  for (const LimitLoad& load : law.limit.loads) json["loads"].push_back(load_json(load));
  json["ellipsoid"] = {{"error", law.limit.ellipsoid_error}, {"at", load_json(law.limit.ellipsoid_farthest)}};
  return json;
}

Json programs_json(const ContactLaw& law) {
  const LammpsTwisting lammps = lammps_twisting(law);
  Json json;
  json["lammps"] = {{"k_twist", lammps.stiffness},
                    {"mu_twist", lammps.arm},
                    {"error", lammps.error},
                    {"error_with_stiffness_at_rest", law.rest_spring.error},
                    {"marshall_limit_error", lammps.marshall_cap_error}};
  if (const auto mujoco = mujoco_friction(law)) {
    json["mujoco"] = {{"friction", {mujoco->sliding, mujoco->torsional, 0.0}},
                      {"lost_presliding", mujoco->lost_presliding},
                      {"combined_error", mujoco->combined_error}};
  } else {
    set_missing(json, "mujoco", "its friction has a length: give a scene");
  }
  if (const auto drake = drake_hydroelastic(law)) {
    json["drake"] = {{"mu_dynamic", drake->mu_dynamic},
                     {"hydroelastic_modulus", drake->modulus},
                     {"contact_radius", drake->contact_radius},
                     {"half_load_error", drake->half_load_error},
                     {"lost_presliding", drake->lost_presliding}};
  } else {
    set_missing(json, "drake", "its modulus is that of a sphere: give the scene of one");
  }
  return json;
}

std::string percent(const Json& value) { return fmt::format("{:+.2g} %", 100.0 * value.get<double>()); }

}  // namespace

Json law_json(const ContactLaw& law) {
  Json json{{"name", law.contact.name}, {"profile", law.contact.profile->name()}};
  json["units"] = units_json(law.contact);
  json["stiffness"] = kStiffness * law.moment_unit() / law.rotation_unit();
  json["moment_limit"] = law.limit_moment();
  json["full_stick"] = law.law.full_stick;
  json["fit"] = {{"error", law.law.error},
                 {"last_deficit", kLastDeficit},
                 {"last_twist", law.law.last_twist},
                 {"logarithm_per_twist", fit_json(law.law.logarithm)},
                 {"twist_per_logarithm", fit_json(law.law.twist)},
                 {"first_logarithm", law.law.first_logarithm},
                 {"loss_power", law.law.loss_power},
                 {"loss_factor", fit_json(law.law.loss_factor)}};
  json["table"] = table_json(law);
  json["elements"] = elements_json(law);
  json["limit_surface"] = limit_json(law);
  json["programs"] = programs_json(law);
  json["provenance"] = provenance(1);
  return json;
}

std::string law_text(const Json& r) {
  const bool in_si = r["units"]["rotation"] == "rad";
  const std::string moment = r["units"]["moment"];
  const Json& fit = r["fit"];
  const auto pieces = [&](const char* key) { return fit[key]["pieces"].size(); };
  const Json& lammps = r["programs"]["lammps"];
  std::string text =
      fmt::format("{}: law of torsion, profile {}\n", r["name"].get<std::string>(),
                  r["profile"].get<std::string>()) +
      text_line("stiffness",
                fmt::format("{} {}, at rest", number_text(r["stiffness"]), in_si ? "N m/rad" : "G a^3")) +
      text_line("limit", fmt::format("{} {}", number_text(r["moment_limit"]), moment)) +
      text_line(
          "fit",
          fmt::format("{} + {} + {} pieces for moment, rotation, loss: within {:.0e}; found {:.1e}, "
                      "{:.1e}, {:.1e}",
                      pieces("logarithm_per_twist"), pieces("twist_per_logarithm"), pieces("loss_factor"),
                      fit["error"].get<double>(), fit["logarithm_per_twist"]["error_found"].get<double>(),
                      fit["twist_per_logarithm"]["error_found"].get<double>(),
                      fit["loss_factor"]["error_found"].get<double>())) +
      text_line("table", fmt::format("{} rows, straight lines in between: within {:.2g} of the limit",
                                     r["table"]["moment"].size(), r["table"]["error"].get<double>())) +
      text_line("elements",
                fmt::format("{} in parallel: within {:.2g} of the limit on first loading, {:.2g} on "
                            "loops between t and -t, {:.2g} after any rotations",
                            r["elements"]["stiffness"].size(), r["elements"]["error"].get<double>(),
                            r["elements"]["loop_error"].get<double>(),
                            r["elements"]["history_error"].get<double>())) +
      text_line("limit surface", fmt::format("{} loads; the ellipsoid through its ends is {} off",
                                             r["limit_surface"]["loads"].size(),
                                             percent(r["limit_surface"]["ellipsoid"]["error"]))) +
      text_line("LAMMPS",
                fmt::format("twisting sds {} 0 {}: up to {} of the limit off; twisting marshall: the "
                            "limit {}",
                            number_text(lammps["k_twist"]), number_text(lammps["mu_twist"]),
                            percent(lammps["error"]), percent(lammps["marshall_limit_error"])));
  if (const Json& mujoco = r["programs"]["mujoco"]; mujoco.is_object()) {
    text += text_line("MuJoCo",
                      fmt::format("friction {} {} 0: the limit exact, no presliding ({} rad at 0.9)",
                                  number_text(mujoco["friction"][0]), number_text(mujoco["friction"][1]),
                                  number_text(mujoco["lost_presliding"])));
  }
  if (const Json& drake = r["programs"]["drake"]; drake.is_object()) {
    text += text_line(
        "Drake", fmt::format("hydroelastic_modulus {}: the limit exact at this load, {} at half of it",
                             number_text(drake["hydroelastic_modulus"]), percent(drake["half_load_error"])));
  }
  return text;
}

}  // namespace slipstick::laws
