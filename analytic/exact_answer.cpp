#include "analytic/exact_answer.hpp"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <ostream>
#include <stdexcept>

#include "analytic/approximations.hpp"
#include "analytic/paper_equations.hpp"

namespace slipstick::analytic {

namespace {

/// The members of a state, and how a person reads them.
struct Quantity {
  const char* key;
  const char* label;
  const char* symbol;
  double TorsionState::*member;
};
constexpr std::array kQuantities{
    Quantity{"moment_ratio", "moment ratio", "M/M_lim", &TorsionState::moment_ratio},
    Quantity{"moment_deficit", "moment deficit", "1 - M/M_lim", &TorsionState::moment_deficit},
    Quantity{"stick_ratio", "stick ratio", "a_s/a", &TorsionState::stick_ratio},
    Quantity{"stick_complement", "stick complement", "1 - a_s/a", &TorsionState::stick_complement},
    Quantity{"twist", "twist", "G a^2 phi/(mu W)", &TorsionState::twist},
    Quantity{"moment", "moment", "M/(mu W a)", &TorsionState::moment},
    Quantity{"tangent_stiffness", "tangent stiffness", "dM/dphi/(G a^3)", &TorsionState::tangent_stiffness},
};

bool is_sphere(const ExactContact& contact) {
  return contact.profile.profile->name() == hertz_profile().name();
}

/// A number, or null and a reason beside it: where there is none (an equation outside its range) or where it
/// is infinite.
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
  for (const Quantity& quantity : kQuantities) json[quantity.key] = state.*quantity.member;
  return json;
}

Json cycle_json(const CycleState& state) {
  return {{"moment_ratio", state.moment_ratio},
          {"moment", state.moment},
          {"twist", state.twist},
          {"stick_ratio", state.stick_ratio},
          {"dissipated", state.dissipated},
          {"tangent_stiffness", state.tangent_stiffness}};
}

/// What the paper's equations give as printed.
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

/// What the interpolation of a table costs each number of its state, by the key of the number; null with a
/// reason where another reading of the points has no such state. Energies and what unloading leaves have
/// none.
void put_error_estimate(Json& answer, const TabulatedProfile& table, const StateQuestion& question) {
  const std::vector<double>& radii = question.radii;
  const auto numbers = [&](const Profile& profile, double mean_pressure) {
    const TorsionState state = question.state(profile);
    std::vector<double> list;
    for (const Quantity& quantity : kQuantities) list.push_back(state.*quantity.member);
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
    for (const Quantity& quantity : kQuantities) json[quantity.key] = *error++;
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

/// In SI units, as far as what was given reaches.
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

/// What makes a table's results numbers in its own units.
Json table_json(const TabulatedProfile& table) {
  return {{"contact_radius", table.radius},
          {"mean_pressure", table.mean_pressure},
          {"load", std::numbers::pi * table.mean_pressure * table.radius * table.radius}};
}

void write_header(std::ostream& out, const ExactContact& contact) {
  const Profile& profile = *contact.profile.profile;
  out << fmt::format(
      "Axisymmetric contact in torsion, profile {}: stick for r < a_s, slip for a_s < r < a (contact "
      "radius).\n"
      "1/G = 1/G_1 + 1/G_2, mu friction, W normal load, p0 the {}: W = {:.9g} p0 a^2, M_lim = {:.9g} mu W "
      "a.\n",
      profile.name(), profile.reference_pressure(), profile.load(), profile.moment_limit());
  if (profile.edge() > 0)
    out << fmt::format("Everything sticks up to M/M_lim = {:.9g}.\n", profile.full_stick());
  if (const auto& table = contact.profile.table)
    out << fmt::format("In the table's units: a = {:.9g}, p0 = {:.9g}.\n", table->radius,
                       table->mean_pressure);
  out << '\n';
}

void write_row(std::ostream& out, const std::string& name, const std::string& symbol, const Json& value) {
  out << fmt::format("{:<20}{:<20}", name, symbol);
  out << (value.is_null() ? fmt::format("{:>23}", "none") : fmt::format("{:>23.15g}", value.get<double>()));
}

void write_line(std::ostream& out, const std::string& name, const std::string& symbol, const Json& value) {
  write_row(out, name, symbol, value);
  out << '\n';
}

/// Another law's value beside the exact one, and how far it is.
void write_beside(std::ostream& out, const std::string& law, const Json& exact, const Json& entry,
                  const std::string& key) {
  if (entry.at(key).is_null()) {
    out << fmt::format("  {}none ({})", law.empty() ? "" : law + ": ",
                       entry.at(key + "_reason").get<std::string>());
    return;
  }
  const auto value = entry.at(key).get<double>();
  const auto reference = exact.is_null() ? 0.0 : exact.get<double>();
  const std::string difference = reference == 0 ? "" : fmt::format("{:+.1e}", value / reference - 1);
  out << fmt::format("{:>23.15g}{:>12}{}{}", value, difference, law.empty() ? "" : "  ", law);
}

bool has_error_estimate(const Json& answer) {
  return answer.contains("error_estimate") && !answer.at("error_estimate").is_null();
}

void write_error(std::ostream& out, const Json& error) {
  out << fmt::format("   +/- {:.1e}", error.get<double>());
}

/// What is known of a table's errors.
void write_table_errors(std::ostream& out, const Json& answer) {
  if (!answer.contains("table")) return;
  if (has_error_estimate(answer)) {
    const Json& errors = answer.at("error_estimate");
    out << fmt::format("p0 +/- {:.1e}, M_lim +/- {:.1e} mu W a.\n", errors.at("mean_pressure").get<double>(),
                       errors.at("moment_limit").get<double>());
    out << "Each +/- is an estimate, no proof, of what interpolation between the points and noise of their "
           "values cost:\nother pressures that fit the points are tried. Energies and what unloading leaves "
           "have none.\n\n";
  } else {
    out << fmt::format("No number has an estimate of its error: {}.\n\n",
                       answer.contains("error_estimate_reason")
                           ? answer.at("error_estimate_reason").get<std::string>()
                           : "for the histories of a table there is none");
  }
}

void write_units(std::ostream& out, const Json& answer) {
  if (!answer.contains("units")) return;
  const std::array<std::array<const char*, 3>, 7> rows{{{"contact_radius", "contact radius", "m"},
                                                        {"approach", "approach", "m"},
                                                        {"reference_pressure", "p0", "Pa"},
                                                        {"stick_radius", "stick radius", "m"},
                                                        {"moment_limit", "limit moment", "N m"},
                                                        {"moment", "moment", "N m"},
                                                        {"twist_angle", "twist", "rad"}}};
  out << '\n';
  for (const auto& [key, label, unit] : rows) {
    if (!answer.at("units").contains(key)) continue;
    write_line(out, label, unit, answer.at("units").at(key));
  }
}

void write_tractions(std::ostream& out, const Json& answer) {
  const Json& tractions = answer.at("traction");
  for (std::size_t i = 0; i < tractions.size(); ++i) {
    const Json& at = tractions[i];
    write_row(out, "traction q/(mu p0)", fmt::format(" at r/a = {:.9g}", at.at("radius").get<double>()),
              at.at("value"));
    if (at.contains("value_reason")) out << fmt::format("  ({})", at.at("value_reason").get<std::string>());
    if (answer.contains("printed"))
      write_beside(out, "Eq. (1)", at.at("value"), answer.at("printed").at("equation_1")[i], "value");
    if (has_error_estimate(answer))
      write_error(out, answer.at("error_estimate").at("traction")[i].at("value"));
    out << '\n';
  }
}

}  // namespace

Json answer_state(const ExactContact& contact, const StateQuestion& question) {
  const Profile& profile = *contact.profile.profile;
  const TorsionState state = question.state(profile);
  Json answer = state_json(state);
  answer["traction"] = at_radii(question.radii, [&](double r) { return traction(state, r, profile); });
  answer["pressure"] = at_radii(question.radii, [&](double r) { return profile.pressure(r); });
  put(answer, "energy_lost_per_cycle", [&] { return energy_lost_per_cycle(state, profile); });
  answer["profile"] = profile_json(profile);
  if (contact.profile.table) answer["table"] = table_json(*contact.profile.table);
  if (question.unload_to) {
    LoadingHistory history(profile);
    history.load_to(state.moment_ratio);
    history.load_to(*question.unload_to);
    answer["unloaded"] = cycle_json(history.state());
    answer["unloaded"]["traction"] = at_radii(question.radii, [&](double r) { return history.traction(r); });
  }
  if (contact.profile.table) put_error_estimate(answer, *contact.profile.table, question);
  if (is_sphere(contact)) {
    answer["printed"] = printed_json(state, question.radii);
    answer["approximations"] = approximations_json(state);
  }
  if (contact.units) answer["units"] = units_json(contact, state.stick_ratio, state.moment, state.twist);
  return answer;
}

void write_state(std::ostream& out, const ExactContact& contact, const Json& answer) {
  write_header(out, contact);
  write_table_errors(out, answer);
  if (answer.contains("printed"))
    out << fmt::format("{:<40}{:>23}{:>23}{:>12}\n", "", "exact", "as printed", "difference");
  for (const Quantity& quantity : kQuantities) {
    const std::string key = quantity.key;
    write_row(out, quantity.label, quantity.symbol, answer.at(key));
    if (answer.contains("printed") && key == "twist")
      write_beside(out, "Eq. (7)", answer.at(key), answer.at("printed"), "equation_7");
    if (answer.contains("printed") && key == "moment")
      write_beside(out, "Eq. (5)", answer.at(key), answer.at("printed"), "equation_5");
    if (has_error_estimate(answer)) write_error(out, answer.at("error_estimate").at(key));
    out << '\n';
  }
  write_line(out, "loss per cycle", "of (mu W)^2/(G a)", answer.at("energy_lost_per_cycle"));
  write_tractions(out, answer);
  if (answer.contains("unloaded")) {
    const Json& back = answer.at("unloaded");
    out << fmt::format("\nback at M/M_lim = {:.9g}:\n", back.at("moment_ratio").get<double>());
    write_line(out, "twist", "G a^2 phi/(mu W)", back.at("twist"));
    write_line(out, "front", "a_s/a", back.at("stick_ratio"));
    write_line(out, "dissipated", "of (mu W)^2/(G a)", back.at("dissipated"));
    write_tractions(out, back);
  }
  write_units(out, answer);
  if (answer.contains("approximations")) {
    out << "\nOther laws' twist at this moment\n";
    for (const Json& law : answer.at("approximations")) {
      out << fmt::format("{:<40}", law.at("law").get<std::string>());
      write_beside(out, "", answer.at("twist"), law, "twist");
      out << '\n';
    }
  }
}

Json answer_history(const ExactContact& contact, const HistoryQuestion& question) {
  const Profile& profile = *contact.profile.profile;
  Json answer;
  answer["profile"] = profile_json(profile);
  if (contact.profile.table) answer["table"] = table_json(*contact.profile.table);
  answer["history"] = Json::array();
  LoadingHistory history(profile);
  for (const double moment_ratio : question.turning_points) {
    history.load_to(moment_ratio);
    Json& entry = answer["history"].emplace_back(cycle_json(history.state()));
    entry["traction"] = at_radii(question.radii, [&](double r) { return history.traction(r); });
  }
  answer["curve"] = Json::array();
  for (const CycleState& state : loading_curve(question.turning_points, question.points_per_branch, profile))
    answer["curve"].push_back(cycle_json(state));
  if (contact.units) {
    const CycleState last = history.state();
    answer["units"] = units_json(contact, last.stick_ratio, last.moment, last.twist);
  }
  return answer;
}

void write_history(std::ostream& out, const ExactContact& contact, const Json& answer) {
  write_header(out, contact);
  write_table_errors(out, answer);
  out << fmt::format("{:>12}{:>26}{:>23}{:>27}\n", "M/M_lim", "twist G a^2 phi/(mu W)", "front a_s/a",
                     "lost, of (mu W)^2/(G a)");
  for (const Json& state : answer.at("history"))
    out << fmt::format("{:>12.9g}{:>26.15g}{:>23.15g}{:>27.15g}\n", state.at("moment_ratio").get<double>(),
                       state.at("twist").get<double>(), state.at("stick_ratio").get<double>(),
                       state.at("dissipated").get<double>());
  for (const Json& state : answer.at("history")) {
    if (state.at("traction").empty()) continue;
    out << fmt::format("\nat M/M_lim = {:.9g}\n", state.at("moment_ratio").get<double>());
    write_tractions(out, state);
  }
  write_units(out, answer);
  out << fmt::format("\nThe curve has {} points (--json FILE).\n", answer.at("curve").size());
}

namespace {

Json certified_json(const certified::Number& number) {
  return {{"value", number.value}, {"radius", number.radius}};
}

struct CertifiedQuantity {
  const char* key;
  const char* label;
  const char* symbol;
  certified::Number certified::State::*member;
};
constexpr std::array kCertified{
    CertifiedQuantity{"moment_ratio", "moment ratio", "M/M_lim", &certified::State::moment_ratio},
    CertifiedQuantity{"moment_deficit", "moment deficit", "1 - M/M_lim", &certified::State::moment_deficit},
    CertifiedQuantity{"stick_ratio", "stick ratio", "a_s/a", &certified::State::stick_ratio},
    CertifiedQuantity{"stick_complement", "stick complement", "1 - a_s/a",
                      &certified::State::stick_complement},
    CertifiedQuantity{"twist", "twist", "G a^2 phi/(mu W)", &certified::State::twist},
    CertifiedQuantity{"moment", "moment", "M/(mu W a)", &certified::State::moment},
    CertifiedQuantity{"tangent_stiffness", "tangent stiffness", "dM/dphi/(G a^3)",
                      &certified::State::tangent_stiffness},
};

void write_certified_row(std::ostream& out, const std::string& name, const std::string& symbol,
                         const Json& number) {
  out << fmt::format("{:<20}{:<20}{}\n{:<40}+/- {}\n", name, symbol, number.at("value").get<std::string>(),
                     "", number.at("radius").get<std::string>());
}

}  // namespace

Json answer_certified(const ExactContact& contact, const CertifiedQuestion& question) {
  const certified::State state = certified::state(certified::profile_named(contact.name), question.given,
                                                  question.value, question.radii, question.digits);
  Json answer;
  for (const CertifiedQuantity& quantity : kCertified)
    answer[quantity.key] = certified_json(state.*quantity.member);
  answer["traction"] = Json::array();
  for (std::size_t i = 0; i < question.radii.size(); ++i)
    answer["traction"].push_back(
        {{"radius", question.radii[i]}, {"value", certified_json(state.traction[i])}});
  answer["profile"] = profile_json(*contact.profile.profile);
  return answer;
}

void write_certified(std::ostream& out, const ExactContact& contact, const Json& answer) {
  write_header(out, contact);
  for (const CertifiedQuantity& quantity : kCertified)
    write_certified_row(out, quantity.label, quantity.symbol, answer.at(quantity.key));
  for (const Json& at : answer.at("traction"))
    write_certified_row(out, "traction q/(mu p0)", " at r/a = " + at.at("radius").get<std::string>(),
                        at.at("value"));
}

}  // namespace slipstick::analytic
