#include "analytic/command/exact_answer.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>

#include "analytic/approximations.hpp"
#include "analytic/interpolation_errors.hpp"
#include "analytic/paper_equations.hpp"

namespace slipstick::analytic {

namespace {

/// A number, or null with a reason: an equation outside its range, or an infinite value.
template <class Function>
void put(Json& object, const std::string& key, Function function) {
  try {
    const double value = function();
    if (std::isfinite(value)) {
      object[key] = value;
      return;
    }
    object[key] = nullptr;
    object[key + "_reason"] = "infinite";
  } catch (const std::domain_error& error) {
    object[key] = nullptr;
    object[key + "_reason"] = error.what();
  }
}

Json at_radii(const std::vector<double>& radii, const std::function<double(double)>& f) {
  Json list = Json::array();
  for (const double r : radii) put(list.emplace_back(Json{{"radius", r}}), "value", [&] { return f(r); });
  return list;
}

Json profile_json(const Profile& profile) {
  return {{"name", profile.name()},
          {"reference_pressure", profile.reference_pressure()},
          {"load", profile.load()},
          {"moment_limit", profile.moment_limit()},
          {"full_stick", profile.full_stick()}};
}

Json state_json(const TorsionState& state) {
  Json json;
  for (const ExactQuantity& quantity : kExactQuantities) json[quantity.key] = state.*quantity.member;
  return json;
}

Json cycle_json(const CycleState& state) {
  return {{"moment_ratio", state.moment_ratio},
          {"moment", state.moment},
          {"twist", state.twist},
          {"stick_ratio", state.stick_ratio},
          {"dissipated", state.dissipated},
          {"dissipated_total", state.dissipated},
          {"tangent_stiffness", state.tangent_stiffness}};
}

/// The values of the paper's equations as printed.
Json printed_json(const TorsionState& state, const std::vector<double>& radii) {
  Json printed;
  printed["equation_1"] = at_radii(radii, [&](double r) { return paper::eq1_printed(state.stick_ratio, r); });
  put(printed, "equation_5", [&] { return paper::eq5_moment(state.stick_ratio); });
  put(printed, "equation_7", [&] { return paper::eq7_twist(state.moment); });
  return printed;
}

Json approximations_json(const TorsionState& state) {
  Json laws = Json::array();
  for (const Approximation& law : approximations()) {
    Json& entry = laws.emplace_back(Json{{"key", law.key}, {"law", law.name}});
    put(entry, "twist", [&] { return law.twist(state.moment); });
  }
  return laws;
}

/// The error that a table's interpolation leaves in each number of the state, by the number's key; null with
/// a reason where another reading of the points has no such state. Energies and the state after unloading
/// have none.
void put_error_estimate(Json& answer, const TabulatedProfile& table, const StateOf& state_of,
                        const std::vector<double>& radii) {
  const auto numbers = [&](const Profile& profile, double mean_pressure) {
    const TorsionState state = state_of(profile);
    std::vector<double> list;
    for (const ExactQuantity& quantity : kExactQuantities) list.push_back(state.*quantity.member);
    for (const double r : radii) list.push_back(traction(state, r, profile));
    for (const double r : radii) list.push_back(profile.pressure(r));
    list.push_back(profile.moment_limit());
    list.push_back(mean_pressure);
    return list;
  };
  try {
    const std::vector<double> errors = interpolation_errors(table, numbers);
    auto error = errors.begin();
    Json json;
    for (const ExactQuantity& quantity : kExactQuantities) json[quantity.key] = *error++;
    json["traction"] = at_radii(radii, [&](double) { return *error++; });
    json["pressure"] = at_radii(radii, [&](double) { return *error++; });
    json["moment_limit"] = *error++;
    json["mean_pressure"] = *error++;
    answer["error_estimate"] = json;
  } catch (const std::exception& failure) {
    answer["error_estimate"] = nullptr;
    answer["error_estimate_reason"] =
        fmt::format("a pressure that fits the points as well has no such state: {}", failure.what());
  }
}

/// The results in SI units, as many as the units given allow.
Json units_json(const ExactContact& contact, double stick_ratio, double moment, double twist) {
  const Units& units = *contact.units;
  const double a = units.indentation.contact_radius;
  Json json{{"contact_radius", a},
            {"approach", units.indentation.approach},
            {"reference_pressure", units.indentation.reference_pressure},
            {"stick_radius", stick_ratio * a}};
  if (!units.friction) return json;
  const double moment_unit = *units.friction * units.load * a;
  json["moment_limit"] = contact.profile.profile->moment_limit() * moment_unit;
  json["moment"] = moment * moment_unit;
  if (units.shear_modulus)
    json["twist_angle"] = twist * *units.friction * units.load / (*units.shear_modulus * a * a);
  return json;
}

/// The scale of a table, by which results become numbers in its own units.
Json table_json(const TabulatedProfile& table) {
  return {{"contact_radius", table.radius},
          {"mean_pressure", table.mean_pressure},
          {"load", std::numbers::pi * table.mean_pressure * table.radius * table.radius}};
}

Json certified_json(const certified::Number& number) {
  return {{"value", number.value}, {"radius", number.radius}};
}

}  // namespace

Json answer_state(const ExactContact& contact, const StateOf& state_of, const std::vector<double>& radii,
                  const std::optional<double>& unload_to) {
  const Profile& profile = *contact.profile.profile;
  const TorsionState state = state_of(profile);
  Json answer = state_json(state);
  answer["traction"] = at_radii(radii, [&](double r) { return traction(state, r, profile); });
  answer["pressure"] = at_radii(radii, [&](double r) { return profile.pressure(r); });
  put(answer, "energy_lost_per_cycle", [&] { return energy_lost_per_cycle(state, profile); });
  answer["profile"] = profile_json(profile);
  if (contact.profile.table) answer["table"] = table_json(*contact.profile.table);
  if (unload_to) {
    LoadingHistory history(profile);
    history.load_to(state.moment_ratio);
    history.load_to(*unload_to);
    answer["unloaded"] = cycle_json(history.state());
    answer["unloaded"]["traction"] = at_radii(radii, [&](double r) { return history.traction(r); });
  }
  if (contact.profile.table) put_error_estimate(answer, *contact.profile.table, state_of, radii);
  if (profile.name() == hertz_profile().name()) {
    answer["printed"] = printed_json(state, radii);
    answer["approximations"] = approximations_json(state);
  }
  if (contact.units) answer["units"] = units_json(contact, state.stick_ratio, state.moment, state.twist);
  return answer;
}

Json answer_history(const ExactContact& contact, const std::vector<double>& turning_points,
                    int points_per_branch, const std::vector<double>& radii) {
  const Profile& profile = *contact.profile.profile;
  Json answer;
  answer["profile"] = profile_json(profile);
  if (contact.profile.table) answer["table"] = table_json(*contact.profile.table);
  answer["history"] = Json::array();
  LoadingHistory history(profile);
  for (const double moment_ratio : turning_points) {
    history.load_to(moment_ratio);
    Json& entry = answer["history"].emplace_back(cycle_json(history.state()));
    entry["traction"] = at_radii(radii, [&](double r) { return history.traction(r); });
  }
  answer["curve"] = Json::array();
  for (const CycleState& state : loading_curve(turning_points, points_per_branch, profile))
    answer["curve"].push_back(cycle_json(state));
  if (contact.units) {
    const CycleState last = history.state();
    answer["units"] = units_json(contact, last.stick_ratio, last.moment, last.twist);
  }
  return answer;
}

Json answer_certified(const ExactContact& contact, certified::Quantity given, const std::string& value,
                      const std::vector<std::string>& radii, int digits) {
  const certified::State state =
      certified::state(certified::profile_named(contact.name), given, value, radii, digits);
  Json answer;
  for (const ExactQuantity& quantity : kExactQuantities)
    answer[quantity.key] = certified_json(state.*quantity.certified);
  answer["traction"] = Json::array();
  for (std::size_t i = 0; i < radii.size(); ++i)
    answer["traction"].push_back({{"radius", radii[i]}, {"value", certified_json(state.traction[i])}});
  answer["profile"] = profile_json(*contact.profile.profile);
  return answer;
}

}  // namespace slipstick::analytic
