#include "analytic/command/exact_answer.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <ostream>
#include <stdexcept>

#include "analytic/paper_equations.hpp"

namespace slipstick::analytic {

/// Null with a reason for a missing number.
static void put(Json& object, const std::string& key, const Number& number) {
  object[key] = number.missing.empty() ? Json(number.value) : Json();
  if (!number.missing.empty()) object[key + "_reason"] = number.missing;
}

static void to_json(Json& json, const AtRadius& at) {
  json = {{"radius", at.radius}};
  put(json, "value", at.number);
}

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

/// A stress's key in the JSON, its name and symbol for a person, and its value.
struct StressRow {
  const char* key;
  const char* label;
  const char* symbol;
  double value;
};

std::vector<StressRow> rows(const AtPoint& point) {
  std::vector<StressRow> list;
  const auto& [rr, tt, zz, rz] = point.pressure;
  if (!std::isnan(rr))
    list = {{"sigma_rr", "stress rr", "sigma_rr/p0", rr},
            {"sigma_tt", "stress tt (hoop)", "sigma_tt/p0", tt},
            {"sigma_zz", "stress zz", "sigma_zz/p0", zz},
            {"sigma_rz", "stress rz", "sigma_rz/p0", rz}};
  list.push_back({"sigma_rt", "stress rt", "sigma_rt/(mu p0)", point.torsion.rt});
  list.push_back({"sigma_tz", "stress tz", "sigma_tz/(mu p0)", point.torsion.tz});
  if (!point.severity || std::isnan(rr)) return list;
  const auto& [von_mises, tresca, tension] = *point.severity;
  list.push_back({"von_mises", "von Mises stress", "sigma_v/p0", von_mises});
  list.push_back({"tresca", "Tresca stress", "(s1 - s3)/p0", tresca});
  list.push_back({"tension", "principal stress", "s1/p0", tension});
  if (point.yield_pressure) list.push_back({"yield_pressure", "p0 at first yield", "Pa", *point.yield_pressure});
  if (point.yield_load) list.push_back({"yield_load", "load at first yield", "N", *point.yield_load});
  return list;
}

}  // namespace

static void to_json(Json& json, const AtPoint& point) {
  json = {{"radius", point.at.radius}, {"depth", point.at.depth}};
  for (const StressRow& row : rows(point)) json[row.key] = row.value;
}

static void to_json(Json& json, const CyclePoint& point) {
  json = point.state;
  json.update({{"traction", point.traction}});
  if (!point.stresses.empty()) json.update({{"stresses", point.stresses}});
}

namespace {

/// Missing where an equation is outside its range, or the value is infinite.
template <class Function>
Number number_of(Function function) {
  try {
    const double value = function();
    return {value, std::isfinite(value) ? "" : "infinite"};
  } catch (const std::domain_error& error) {
    return {0, error.what()};
  }
}

template <class Function>
AtRadii at_radii(const std::vector<double>& radii, Function f) {
  AtRadii list;
  for (const double r : radii) list.push_back({r, number_of([&] { return f(r); })});
  return list;
}

/// The error that a table's interpolation leaves in each number of the state. Throws where another reading of
/// the points has no such state. Energies and the state after unloading have none.
TableErrors table_errors(const TabulatedProfile& table, const StateOf& state_of, const std::vector<double>& radii) {
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
  const std::vector<double> errors = interpolation_errors(table, numbers);
  auto error = errors.begin();
  const auto next = [&](double) { return *error++; };
  TorsionState state{};
  for (const ExactQuantity& quantity : kExactQuantities) state.*quantity.member = *error++;
  return {{state, at_radii(radii, next), at_radii(radii, next)}, error[0], error[1]};
}

/// The results in SI units, as many as the units given allow.
std::vector<UnitsRow> units_rows(const ExactContact& contact, double stick_ratio, double moment, double twist) {
  if (!contact.units) return {};
  const Units& units = *contact.units;
  const double a = units.indentation.contact_radius;
  std::vector<UnitsRow> rows{{"contact_radius", "contact radius", "m", a},
                             {"approach", "approach", "m", units.indentation.approach},
                             {"reference_pressure", "p0", "Pa", units.indentation.reference_pressure},
                             {"stick_radius", "stick radius", "m", stick_ratio * a}};
  if (!units.friction) return rows;
  const double moment_unit = *units.friction * units.load * a;
  rows.push_back({"moment_limit", "limit moment", "N m", contact.profile.profile->moment_limit() * moment_unit});
  rows.push_back({"moment", "moment", "N m", moment * moment_unit});
  if (units.shear_modulus)
    rows.push_back(
        {"twist_angle", "twist", "rad", twist * *units.friction * units.load / (*units.shear_modulus * a * a)});
  return rows;
}

CyclePoint cycle_point(const LoadingHistory& history, const std::vector<double>& radii) {
  return {history.state(), at_radii(radii, [&](double r) { return history.traction(r); })};
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
    json.update({{"table",
                  {{"contact_radius", table->radius},
                   {"mean_pressure", table->mean_pressure},
                   {"load", std::numbers::pi * table->mean_pressure * table->radius * table->radius}}}});
  return json;
}

Json numbers_json(const StateNumbers& numbers) {
  Json json;
  for (const ExactQuantity& quantity : kExactQuantities) json[quantity.key] = numbers.state.*quantity.member;
  json.update({{"traction", numbers.traction}, {"pressure", numbers.pressure}});
  return json;
}

Json printed_json(const OtherLaws& laws) {
  Json printed{{"equation_1", laws.equation_1}};
  put(printed, "equation_5", laws.equation_5);
  put(printed, "equation_7", laws.equation_7);
  Json list = Json::array();
  for (std::size_t i = 0; i < approximations().size(); ++i) {
    list.push_back({{"key", approximations()[i].key}, {"law", approximations()[i].name}});
    put(list.back(), "twist", laws.law_twists[i]);
  }
  return {{"printed", printed}, {"approximations", list}};
}

Json units_json(const std::vector<UnitsRow>& rows) {
  if (rows.empty()) return Json::object();
  Json json;
  for (const UnitsRow& row : rows) json[row.key] = row.value;
  return {{"units", json}};
}

Json certified_json(const certified::Number& number) { return {{"value", number.value}, {"radius", number.radius}}; }

void write_header(std::ostream& out, const ExactContact& contact) {
  const Profile& profile = *contact.profile.profile;
  out << fmt::format(
      "Axisymmetric contact in torsion, profile {}: stick for r < a_s, slip for a_s < r < a (contact "
      "radius).\n"
      "1/G = 1/G_1 + 1/G_2, mu friction, W normal load, p0 the {}: W = {:.9g} p0 a^2, M_lim = {:.9g} mu W "
      "a.\n",
      profile.name(), profile.reference_pressure(), profile.load(), profile.moment_limit());
  if (profile.edge() > 0) out << fmt::format("Everything sticks up to M/M_lim = {:.9g}.\n", profile.full_stick());
  if (const auto& table = contact.profile.table)
    out << fmt::format("In the table's units: a = {:.9g}, p0 = {:.9g}.\n", table->radius, table->mean_pressure);
  out << '\n';
}

void write_row(std::ostream& out, const std::string& name, const std::string& symbol, const Number& number) {
  out << fmt::format("{:<20}{:<20}", name, symbol);
  out << (number.missing.empty() ? fmt::format("{:>23.15g}", number.value) : fmt::format("{:>23}", "none"));
}

void write_line(std::ostream& out, const std::string& name, const std::string& symbol, const Number& number) {
  write_row(out, name, symbol, number);
  out << '\n';
}

/// Another law's value and its distance from the exact one.
void write_beside(std::ostream& out, const std::string& law, const Number& exact, const Number& number) {
  if (!number.missing.empty()) {
    out << fmt::format("  {}none ({})", law.empty() ? "" : law + ": ", number.missing);
    return;
  }
  const bool comparable = exact.missing.empty() && exact.value != 0;
  const std::string difference = comparable ? fmt::format("{:+.1e}", number.value / exact.value - 1) : "";
  out << fmt::format("{:>23.15g}{:>12}{}{}", number.value, difference, law.empty() ? "" : "  ", law);
}

void write_no_errors(std::ostream& out, const std::string& reason) {
  out << fmt::format("No number has an estimate of its error: {}.\n\n", reason);
}

void write_units(std::ostream& out, const std::vector<UnitsRow>& rows) {
  if (!rows.empty()) out << '\n';
  for (const auto& [key, label, unit, value] : rows) write_line(out, label, unit, {value});
}

void write_tractions(std::ostream& out, const AtRadii& tractions, const AtRadii* printed = nullptr,
                     const AtRadii* errors = nullptr) {
  for (std::size_t i = 0; i < tractions.size(); ++i) {
    const auto& [radius, number] = tractions[i];
    write_row(out, "traction q/(mu p0)", fmt::format(" at r/a = {:.9g}", radius), number);
    if (!number.missing.empty()) out << fmt::format("  ({})", number.missing);
    if (printed) write_beside(out, "Eq. (1)", number, (*printed)[i].number);
    if (errors) out << fmt::format("   +/- {:.1e}", (*errors)[i].number.value);
    out << '\n';
  }
}

void write_stresses(std::ostream& out, const AtPoints& points) {
  for (const AtPoint& point : points) {
    out << fmt::format("at r/a = {:.9g}, depth z/a = {:.9g}:\n", point.at.radius, point.at.depth);
    for (const auto& [key, label, symbol, value] : rows(point)) write_line(out, label, symbol, {value});
  }
}

void write_certified_row(std::ostream& out, const std::string& name, const std::string& symbol,
                         const certified::Number& number) {
  out << fmt::format("{:<20}{:<20}{}\n{:<40}+/- {}\n", name, symbol, number.value, "", number.radius);
}

}  // namespace

AtPoints at_points(const StressField& field, const std::vector<BodyPoint>& points, double poisson,
                   const std::optional<double>& friction) {
  AtPoints list;
  for (const BodyPoint at : points) {
    list.push_back({at, field.by_pressure(at, poisson), field.by_torsion(at)});
    if (friction) list.back().severity = severity(list.back().pressure, list.back().torsion, *friction);
  }
  return list;
}

StateAnswer answer_state(const ExactContact& contact, const StateOf& state_of, const std::vector<double>& radii,
                         const std::optional<double>& unload_to) {
  const Profile& profile = *contact.profile.profile;
  const TorsionState state = state_of(profile);
  StateAnswer answer{.contact = contact,
                     .numbers = {state, at_radii(radii, [&](double r) { return traction(state, r, profile); }),
                                 at_radii(radii, [&](double r) { return profile.pressure(r); })},
                     .energy_lost_per_cycle = number_of([&] { return energy_lost_per_cycle(state, profile); }),
                     .units = units_rows(contact, state.stick_ratio, state.moment, state.twist)};
  if (unload_to) {
    LoadingHistory history(profile);
    history.load_to(state.moment_ratio);
    history.load_to(*unload_to);
    answer.unloaded = cycle_point(history, radii);
  }
  if (contact.profile.table) try {
      answer.errors = table_errors(*contact.profile.table, state_of, radii);
    } catch (const std::exception& failure) {
      answer.errors_missing =
          fmt::format("a pressure that fits the points as well has no such state: {}", failure.what());
    }
  if (profile.name() == hertz_profile().name()) {
    answer.printed = OtherLaws{at_radii(radii, [&](double r) { return paper::eq1_printed(state.stick_ratio, r); }),
                               number_of([&] { return paper::eq5_moment(state.stick_ratio); }),
                               number_of([&] { return paper::eq7_twist(state.moment); }),
                               {}};
    for (const Approximation& law : approximations())
      answer.printed->law_twists.push_back(number_of([&] { return law.twist(state.moment); }));
  }
  return answer;
}

Json to_json(const StateAnswer& answer) {
  Json json = numbers_json(answer.numbers);
  put(json, "energy_lost_per_cycle", answer.energy_lost_per_cycle);
  json.update(contact_json(answer.contact));
  if (!answer.stresses.empty()) json.update({{"stresses", answer.stresses}});
  if (answer.unloaded) json.update({{"unloaded", *answer.unloaded}});
  if (const auto& errors = answer.errors) {
    Json estimate = numbers_json(errors->numbers);
    estimate.update({{"moment_limit", errors->moment_limit}, {"mean_pressure", errors->mean_pressure}});
    json.update({{"error_estimate", estimate}});
  } else if (answer.contact.profile.table) {
    json.update({{"error_estimate", nullptr}, {"error_estimate_reason", answer.errors_missing}});
  }
  if (answer.printed) json.update(printed_json(*answer.printed));
  json.update(units_json(answer.units));
  return json;
}

HistoryAnswer answer_history(const ExactContact& contact, const std::vector<double>& turning_points,
                             int points_per_branch, const std::vector<double>& radii) {
  const Profile& profile = *contact.profile.profile;
  HistoryAnswer answer{.contact = contact};
  LoadingHistory history(profile);
  for (const double moment_ratio : turning_points) {
    history.load_to(moment_ratio);
    answer.history.push_back(cycle_point(history, radii));
  }
  answer.curve = loading_curve(turning_points, points_per_branch, profile);
  const CycleState last = history.state();
  answer.units = units_rows(contact, last.stick_ratio, last.moment, last.twist);
  return answer;
}

Json to_json(const HistoryAnswer& answer) {
  Json json = contact_json(answer.contact);
  json.update({{"history", answer.history}, {"curve", answer.curve}});
  json.update(units_json(answer.units));
  return json;
}

Json to_json(const CertifiedAnswer& answer) {
  Json json;
  for (const ExactQuantity& quantity : kExactQuantities)
    json[quantity.key] = certified_json(answer.state.*quantity.certified);
  Json tractions = Json::array();
  for (std::size_t i = 0; i < answer.radii.size(); ++i)
    tractions.push_back({{"radius", answer.radii[i]}, {"value", certified_json(answer.state.traction[i])}});
  json.update({{"traction", tractions}});
  json.update(contact_json(answer.contact));
  return json;
}

void write(std::ostream& out, const StateAnswer& answer) {
  write_header(out, answer.contact);
  const auto& errors = answer.errors;
  const auto& printed = answer.printed;
  if (errors)
    out << fmt::format(
        "p0 +/- {:.1e}, M_lim +/- {:.1e} mu W a.\n"
        "Each +/- estimates, without proof, the error by interpolation between the points and by noise of "
        "their\n"
        "values, from other pressures that fit the points. Energies and residual values have none.\n\n",
        errors->mean_pressure, errors->moment_limit);
  else if (answer.contact.profile.table)
    write_no_errors(out, answer.errors_missing);
  if (printed) out << fmt::format("{:<40}{:>23}{:>23}{:>12}\n", "", "exact", "as printed", "difference");
  for (const ExactQuantity& quantity : kExactQuantities) {
    const Number number{answer.numbers.state.*quantity.member};
    write_row(out, quantity.label, quantity.symbol, number);
    if (printed && quantity.member == &TorsionState::twist) write_beside(out, "Eq. (7)", number, printed->equation_7);
    if (printed && quantity.member == &TorsionState::moment) write_beside(out, "Eq. (5)", number, printed->equation_5);
    if (errors) out << fmt::format("   +/- {:.1e}", errors->numbers.state.*quantity.member);
    out << '\n';
  }
  write_line(out, "loss per cycle", "of (mu W)^2/(G a)", answer.energy_lost_per_cycle);
  write_tractions(out, answer.numbers.traction, printed ? &printed->equation_1 : nullptr,
                  errors ? &errors->numbers.traction : nullptr);
  write_stresses(out, answer.stresses);
  if (answer.unloaded) {
    const auto& [state, tractions, stresses] = *answer.unloaded;
    out << fmt::format("\nback at M/M_lim = {:.9g}:\n", state.moment_ratio);
    write_line(out, "twist", "G a^2 phi/(mu W)", {state.twist});
    write_line(out, "front", "a_s/a", {state.stick_ratio});
    write_line(out, "dissipated", "of (mu W)^2/(G a)", {state.dissipated});
    write_tractions(out, tractions);
    write_stresses(out, stresses);
  }
  write_units(out, answer.units);
  if (!printed) return;
  out << "\nOther laws' twist at this moment\n";
  for (std::size_t i = 0; i < approximations().size(); ++i) {
    out << fmt::format("{:<40}", approximations()[i].name);
    write_beside(out, "", {answer.numbers.state.twist}, printed->law_twists[i]);
    out << '\n';
  }
}

void write(std::ostream& out, const HistoryAnswer& answer) {
  write_header(out, answer.contact);
  if (answer.contact.profile.table) write_no_errors(out, "for the histories of a table there is none");
  out << fmt::format("{:>12}{:>26}{:>23}{:>27}\n", "M/M_lim", "twist G a^2 phi/(mu W)", "front a_s/a",
                     "lost, of (mu W)^2/(G a)");
  for (const auto& [state, tractions, stresses] : answer.history)
    out << fmt::format("{:>12.9g}{:>26.15g}{:>23.15g}{:>27.15g}\n", state.moment_ratio, state.twist, state.stick_ratio,
                       state.dissipated);
  for (const auto& [state, tractions, stresses] : answer.history) {
    if (tractions.empty() && stresses.empty()) continue;
    out << fmt::format("\nat M/M_lim = {:.9g}\n", state.moment_ratio);
    write_tractions(out, tractions);
    write_stresses(out, stresses);
  }
  write_units(out, answer.units);
  out << fmt::format("\nThe curve has {} points (--json FILE).\n", answer.curve.size());
}

void write(std::ostream& out, const CertifiedAnswer& answer) {
  write_header(out, answer.contact);
  for (const ExactQuantity& quantity : kExactQuantities)
    write_certified_row(out, quantity.label, quantity.symbol, answer.state.*quantity.certified);
  for (std::size_t i = 0; i < answer.radii.size(); ++i)
    write_certified_row(out, "traction q/(mu p0)", " at r/a = " + answer.radii[i], answer.state.traction[i]);
}

}  // namespace slipstick::analytic
