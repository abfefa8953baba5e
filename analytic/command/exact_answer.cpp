#include "analytic/command/exact_answer.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <ostream>
#include <span>
#include <stdexcept>

#include "analytic/paper_equations.hpp"

namespace slipstick::analytic {

static void to_json(Json& json, const CycleState& state) {
  json = {{"moment_ratio", state.moment_ratio},
          {"moment", state.moment},
          {"twist", state.twist},
          {"stick_ratio", state.stick_ratio},
          {"dissipated", state.dissipated},
          {"dissipated_total", state.dissipated},
          {"tangent_stiffness", state.tangent_stiffness}};
}

namespace {

/// Null with a reason where an equation is outside its range, or the value is infinite.
template <class Function>
void put(Json& object, const std::string& key, Function function) {
  Json& number = object[key] = nullptr;
  try {
    const double value = function();
    if (std::isfinite(value)) {
      number = value;
    } else {
      object[key + "_reason"] = "infinite";
    }
  } catch (const std::domain_error& error) {
    object[key + "_reason"] = error.what();
  }
}

template <class Function>
Json at_radii(const std::vector<double>& radii, Function f) {
  Json list = Json::array();
  for (const double r : radii) put(list.emplace_back(Json{{"radius", r}}), "value", [&] { return f(r); });
  return list;
}

/// The profile and, of a table, the scale by which results become numbers in its own units.
Json contact_json(const ExactContact& contact) {
  const Profile& profile = *contact.profile.profile;
  Json json{{"profile",
             {{"name", profile.name()},
              {"reference_pressure", profile.reference_pressure()},
              {"load", profile.load()},
              {"moment_limit", profile.moment_limit()},
              {"full_stick", profile.full_stick()}}}};
  if (const auto& table = contact.profile.table)
    json["table"] = {{"contact_radius", table->radius},
                     {"mean_pressure", table->mean_pressure},
                     {"load", std::numbers::pi * table->mean_pressure * table->radius * table->radius}};
  return json;
}

/// The error that a table's interpolation leaves in each number of the state; none where another reading of
/// the points has no such state. Energies and the state after unloading have none.
void put_errors(Json& json, const TabulatedProfile& table, const StateOf& state_of, const std::vector<double>& radii) {
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
  Json& estimate = json["error_estimate"] = nullptr;
  try {
    const std::vector<double> errors = interpolation_errors(table, numbers);
    auto error = errors.begin();
    const auto next = [&](double) { return *error++; };
    for (const ExactQuantity& quantity : kExactQuantities) estimate[quantity.key] = *error++;
    estimate["traction"] = at_radii(radii, next);
    estimate["pressure"] = at_radii(radii, next);
    estimate["moment_limit"] = error[0];
    estimate["mean_pressure"] = error[1];
  } catch (const std::exception& failure) {
    json["error_estimate_reason"] =
        fmt::format("a pressure that fits the points as well has no such state: {}", failure.what());
  }
}

/// The results in SI units, as many as the units given allow.
void put_units(Json& json, const ExactContact& contact, double stick_ratio, double moment, double twist) {
  if (!contact.units) return;
  const Units& units = *contact.units;
  const double a = units.indentation.contact_radius;
  json["units"] = {{"contact_radius", a},
                   {"approach", units.indentation.approach},
                   {"reference_pressure", units.indentation.reference_pressure},
                   {"stick_radius", stick_ratio * a}};
  if (!units.friction) return;
  const double moment_unit = *units.friction * units.load * a;
  json["units"]["moment_limit"] = contact.profile.profile->moment_limit() * moment_unit;
  json["units"]["moment"] = moment * moment_unit;
  if (units.shear_modulus)
    json["units"]["twist_angle"] = twist * *units.friction * units.load / (*units.shear_modulus * a * a);
}

void put_stresses(Json& json, const Json& stresses) {
  if (!stresses.empty()) json["stresses"] = stresses;
}

Json cycle_point(const LoadingHistory& history, const Profile& profile, const std::vector<double>& radii,
                 const StressesOf& stresses_of) {
  const CycleState state = history.state();
  Json json = state;
  json["traction"] = at_radii(radii, [&](double r) { return history.traction(r); });
  put_stresses(json, stresses_of({history, profile}, state.stick_ratio));
  return json;
}

void put_other_laws(Json& json, const TorsionState& state, const std::vector<double>& radii) {
  Json& printed = json["printed"] = {
      {"equation_1", at_radii(radii, [&](double r) { return paper::eq1_printed(state.stick_ratio, r); })}};
  put(printed, "equation_5", [&] { return paper::eq5_moment(state.stick_ratio); });
  put(printed, "equation_7", [&] { return paper::eq7_twist(state.moment); });
  for (const Approximation& law : approximations())
    put(json["approximations"].emplace_back(Json{{"key", law.key}, {"law", law.name}}), "twist",
        [&] { return law.twist(state.moment); });
}

Json certified_json(const certified::Number& number) { return {{"value", number.value}, {"radius", number.radius}}; }

// ---------------------------------------------------------------- text

/// A number of an answer, and its name and symbol for a person.
struct Row {
  const char* key;
  const char* label;
  const char* symbol;
};
constexpr std::array kStresses{
    Row{"sigma_rr", "stress rr", "sigma_rr/p0"},        Row{"sigma_tt", "stress tt (hoop)", "sigma_tt/p0"},
    Row{"sigma_zz", "stress zz", "sigma_zz/p0"},        Row{"sigma_rz", "stress rz", "sigma_rz/p0"},
    Row{"sigma_rt", "stress rt", "sigma_rt/(mu p0)"},   Row{"sigma_tz", "stress tz", "sigma_tz/(mu p0)"},
    Row{"von_mises", "von Mises stress", "sigma_v/p0"}, Row{"tresca", "Tresca stress", "(s1 - s3)/p0"},
    Row{"tension", "principal stress", "s1/p0"},        Row{"yield_pressure", "p0 at first yield", "Pa"},
    Row{"yield_load", "load at first yield", "N"}};
constexpr std::array kUnloaded{Row{"twist", "twist", "G a^2 phi/(mu W)"},  //
                               Row{"stick_ratio", "front", "a_s/a"},
                               Row{"dissipated", "dissipated", "of (mu W)^2/(G a)"}};
constexpr std::array kUnits{Row{"contact_radius", "contact radius", "m"},
                            Row{"approach", "approach", "m"},
                            Row{"reference_pressure", "p0", "Pa"},
                            Row{"stick_radius", "stick radius", "m"},
                            Row{"moment_limit", "limit moment", "N m"},
                            Row{"moment", "moment", "N m"},
                            Row{"twist_angle", "twist", "rad"}};

/// Null where there is none.
const Json& find(const Json& json, const char* key) {
  static const Json none;
  const auto found = json.find(key);
  return found == json.end() ? none : *found;
}
double number(const Json& json, const char* key) { return json.at(key); }
std::string text(const Json& json, const std::string& key) { return json.at(key); }

void write_header(std::ostream& out, const Json& answer) {
  const Json& profile = answer.at("profile");
  out << fmt::format(
      "Axisymmetric contact in torsion, profile {}: stick for r < a_s, slip for a_s < r < a (contact "
      "radius).\n"
      "1/G = 1/G_1 + 1/G_2, mu friction, W normal load, p0 the {}: W = {:.9g} p0 a^2, M_lim = {:.9g} mu W "
      "a.\n",
      text(profile, "name"), text(profile, "reference_pressure"), number(profile, "load"),
      number(profile, "moment_limit"));
  if (const double stuck = number(profile, "full_stick"); stuck > 0)
    out << fmt::format("Everything sticks up to M/M_lim = {:.9g}.\n", stuck);
  if (const Json& table = find(answer, "table"); !table.is_null())
    out << fmt::format("In the table's units: a = {:.9g}, p0 = {:.9g}.\n", number(table, "contact_radius"),
                       number(table, "mean_pressure"));
  out << '\n';
}

void write_row(std::ostream& out, const std::string& name, const std::string& symbol, const Json& number) {
  out << fmt::format("{:<20}{:<20}", name, symbol);
  out << (number.is_null() ? fmt::format("{:>23}", "none") : fmt::format("{:>23.15g}", number.get<double>()));
}

/// As many as there are.
void write_rows(std::ostream& out, std::span<const Row> rows, const Json& numbers) {
  for (const auto& [key, label, symbol] : rows) {
    if (!numbers.contains(key)) continue;
    write_row(out, label, symbol, numbers.at(key));
    out << '\n';
  }
}

/// Another law's value and its distance from the exact one.
void write_beside(std::ostream& out, const std::string& law, const Json& exact, const Json& other,
                  const std::string& key) {
  if (other.at(key).is_null()) {
    out << fmt::format("  {}none ({})", law.empty() ? "" : law + ": ", text(other, key + "_reason"));
    return;
  }
  const double value = other.at(key);
  const bool comparable = !exact.is_null() && exact != 0;
  const std::string difference = comparable ? fmt::format("{:+.1e}", value / exact.get<double>() - 1) : "";
  out << fmt::format("{:>23.15g}{:>12}{}{}", value, difference, law.empty() ? "" : "  ", law);
}

void write_no_errors(std::ostream& out, const std::string& reason) {
  out << fmt::format("No number has an estimate of its error: {}.\n\n", reason);
}

void write_units(std::ostream& out, const Json& answer) {
  const Json& units = find(answer, "units");
  if (units.is_null()) return;
  out << '\n';
  write_rows(out, kUnits, units);
}

void write_tractions(std::ostream& out, const Json& tractions, const Json& printed = {}, const Json& errors = {}) {
  for (std::size_t i = 0; i < tractions.size(); ++i) {
    const Json& number = tractions[i].at("value");
    write_row(out, "traction q/(mu p0)", fmt::format(" at r/a = {:.9g}", analytic::number(tractions[i], "radius")),
              number);
    if (number.is_null()) out << fmt::format("  ({})", text(tractions[i], "value_reason"));
    if (!printed.is_null()) write_beside(out, "Eq. (1)", number, printed[i], "value");
    if (!errors.is_null()) out << fmt::format("   +/- {:.1e}", analytic::number(errors[i], "value"));
    out << '\n';
  }
}

void write_stresses(std::ostream& out, const Json& answer) {
  for (const Json& point : find(answer, "stresses")) {
    out << fmt::format("at r/a = {:.9g}, depth z/a = {:.9g}:\n", number(point, "radius"), number(point, "depth"));
    write_rows(out, kStresses, point);
  }
}

void write_certified_row(std::ostream& out, const std::string& name, const std::string& symbol, const Json& number) {
  out << fmt::format("{:<20}{:<20}{}\n{:<40}+/- {}\n", name, symbol, text(number, "value"), "", text(number, "radius"));
}

}  // namespace

Json stresses_at(BodyPoint at, const StressField& field, double poisson, const std::optional<double>& friction) {
  const PressureStress normal = field.by_pressure(at, poisson);
  const TorsionStress shear = field.by_torsion(at);
  Json json{{"radius", at.radius}, {"depth", at.depth}};
  const bool known = !std::isnan(normal.rr);
  if (known)
    json.update({{"sigma_rr", normal.rr}, {"sigma_tt", normal.tt}, {"sigma_zz", normal.zz}, {"sigma_rz", normal.rz}});
  json.update({{"sigma_rt", shear.rt}, {"sigma_tz", shear.tz}});
  if (!known || !friction) return json;
  const auto& [von_mises, tresca, tension] = severity(normal, shear, *friction);
  json.update({{"von_mises", von_mises}, {"tresca", tresca}, {"tension", tension}});
  return json;
}

Json answer_state(const ExactContact& contact, const StateOf& state_of, const std::vector<double>& radii,
                  const std::optional<double>& unload_to, const StressesOf& stresses_of) {
  const Profile& profile = *contact.profile.profile;
  const TorsionState state = state_of(profile);
  Json json;
  for (const ExactQuantity& quantity : kExactQuantities) json[quantity.key] = state.*quantity.member;
  json["traction"] = at_radii(radii, [&](double r) { return traction(state, r, profile); });
  json["pressure"] = at_radii(radii, [&](double r) { return profile.pressure(r); });
  put(json, "energy_lost_per_cycle", [&] { return energy_lost_per_cycle(state, profile); });
  json.update(contact_json(contact));
  put_stresses(json, stresses_of({state, profile}, state.stick_ratio));
  if (unload_to) {
    LoadingHistory history(profile);
    history.load_to(state.moment_ratio);
    history.load_to(*unload_to);
    json["unloaded"] = cycle_point(history, profile, radii, stresses_of);
  }
  if (contact.profile.table) put_errors(json, *contact.profile.table, state_of, radii);
  if (profile.name() == hertz_profile().name()) put_other_laws(json, state, radii);
  put_units(json, contact, state.stick_ratio, state.moment, state.twist);
  return json;
}

Json answer_history(const ExactContact& contact, const std::vector<double>& turning_points, int points_per_branch,
                    const std::vector<double>& radii, const StressesOf& stresses_of) {
  const Profile& profile = *contact.profile.profile;
  Json json = contact_json(contact);
  LoadingHistory history(profile);
  for (const double moment_ratio : turning_points) {
    history.load_to(moment_ratio);
    json["history"].push_back(cycle_point(history, profile, radii, stresses_of));
  }
  json["curve"] = loading_curve(turning_points, points_per_branch, profile);
  const CycleState last = history.state();
  put_units(json, contact, last.stick_ratio, last.moment, last.twist);
  return json;
}

Json answer_certified(const ExactContact& contact, const certified::State& state,
                      const std::vector<std::string>& radii) {
  Json json;
  for (const ExactQuantity& quantity : kExactQuantities) json[quantity.key] = certified_json(state.*quantity.certified);
  Json& tractions = json["traction"] = Json::array();
  for (std::size_t i = 0; i < radii.size(); ++i)
    tractions.push_back({{"radius", radii[i]}, {"value", certified_json(state.traction[i])}});
  json.update(contact_json(contact));
  return json;
}

void write_state(std::ostream& out, const Json& answer) {
  write_header(out, answer);
  const Json& errors = find(answer, "error_estimate");
  const Json& printed = find(answer, "printed");
  if (errors.is_object())
    out << fmt::format(
        "p0 +/- {:.1e}, M_lim +/- {:.1e} mu W a.\n"
        "Each +/- estimates, without proof, the error by interpolation between the points and by noise of "
        "their\n"
        "values, from other pressures that fit the points. Energies and residual values have none.\n\n",
        number(errors, "mean_pressure"), number(errors, "moment_limit"));
  else if (answer.contains("error_estimate_reason"))
    write_no_errors(out, text(answer, "error_estimate_reason"));
  if (!printed.is_null()) out << fmt::format("{:<40}{:>23}{:>23}{:>12}\n", "", "exact", "as printed", "difference");
  for (const auto& [key, label, symbol, member, certified] : kExactQuantities) {
    const Json& value = answer.at(key);
    write_row(out, label, symbol, value);
    if (!printed.is_null() && member == &TorsionState::twist)
      write_beside(out, "Eq. (7)", value, printed, "equation_7");
    if (!printed.is_null() && member == &TorsionState::moment)
      write_beside(out, "Eq. (5)", value, printed, "equation_5");
    if (errors.is_object()) out << fmt::format("   +/- {:.1e}", number(errors, key));
    out << '\n';
  }
  write_rows(out, std::array{Row{"energy_lost_per_cycle", "loss per cycle", "of (mu W)^2/(G a)"}}, answer);
  write_tractions(out, answer.at("traction"), find(printed, "equation_1"), find(errors, "traction"));
  write_stresses(out, answer);
  if (const Json& unloaded = find(answer, "unloaded"); !unloaded.is_null()) {
    out << fmt::format("\nback at M/M_lim = {:.9g}:\n", number(unloaded, "moment_ratio"));
    write_rows(out, kUnloaded, unloaded);
    write_tractions(out, unloaded.at("traction"));
    write_stresses(out, unloaded);
  }
  write_units(out, answer);
  if (printed.is_null()) return;
  out << "\nOther laws' twist at this moment\n";
  for (const Json& law : answer.at("approximations")) {
    out << fmt::format("{:<40}", text(law, "law"));
    write_beside(out, "", answer.at("twist"), law, "twist");
    out << '\n';
  }
}

void write_history(std::ostream& out, const Json& answer) {
  write_header(out, answer);
  if (answer.contains("table")) write_no_errors(out, "for the histories of a table there is none");
  out << fmt::format("{:>12}{:>26}{:>23}{:>27}\n", "M/M_lim", "twist G a^2 phi/(mu W)", "front a_s/a",
                     "lost, of (mu W)^2/(G a)");
  for (const Json& point : answer.at("history"))
    out << fmt::format("{:>12.9g}{:>26.15g}{:>23.15g}{:>27.15g}\n", number(point, "moment_ratio"),
                       number(point, "twist"), number(point, "stick_ratio"), number(point, "dissipated"));
  for (const Json& point : answer.at("history")) {
    if (point.at("traction").empty() && !point.contains("stresses")) continue;
    out << fmt::format("\nat M/M_lim = {:.9g}\n", number(point, "moment_ratio"));
    write_tractions(out, point.at("traction"));
    write_stresses(out, point);
  }
  write_units(out, answer);
  out << fmt::format("\nThe curve has {} points (--json FILE).\n", answer.at("curve").size());
}

void write_certified(std::ostream& out, const Json& answer) {
  write_header(out, answer);
  for (const ExactQuantity& quantity : kExactQuantities)
    write_certified_row(out, quantity.label, quantity.symbol, answer.at(quantity.key));
  for (const Json& traction : answer.at("traction"))
    write_certified_row(out, "traction q/(mu p0)", " at r/a = " + text(traction, "radius"), traction.at("value"));
}

}  // namespace slipstick::analytic
