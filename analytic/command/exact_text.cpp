#include "analytic/command/exact_text.hpp"

#include <fmt/core.h>

#include <array>
#include <nlohmann/json.hpp>
#include <ostream>

namespace slipstick::analytic {

namespace {

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

/// Another law's value and its distance from the exact one.
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

/// The errors of a table's numbers, or why there are none.
void write_table_errors(std::ostream& out, const Json& answer) {
  if (!answer.contains("table")) return;
  if (has_error_estimate(answer)) {
    const Json& errors = answer.at("error_estimate");
    out << fmt::format("p0 +/- {:.1e}, M_lim +/- {:.1e} mu W a.\n", errors.at("mean_pressure").get<double>(),
                       errors.at("moment_limit").get<double>());
    out << "Each +/- estimates, without proof, the error by interpolation between the points and by noise of "
           "their\n"
           "values, from other pressures that fit the points. Energies and residual values have none.\n\n";
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

void write_certified_row(std::ostream& out, const std::string& name, const std::string& symbol,
                         const Json& number) {
  out << fmt::format("{:<20}{:<20}{}\n{:<40}+/- {}\n", name, symbol, number.at("value").get<std::string>(),
                     "", number.at("radius").get<std::string>());
}

}  // namespace

void write_state(std::ostream& out, const ExactContact& contact, const Json& answer) {
  write_header(out, contact);
  write_table_errors(out, answer);
  if (answer.contains("printed"))
    out << fmt::format("{:<40}{:>23}{:>23}{:>12}\n", "", "exact", "as printed", "difference");
  for (const ExactQuantity& quantity : kExactQuantities) {
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

void write_certified(std::ostream& out, const ExactContact& contact, const Json& answer) {
  write_header(out, contact);
  for (const ExactQuantity& quantity : kExactQuantities)
    write_certified_row(out, quantity.label, quantity.symbol, answer.at(quantity.key));
  for (const Json& at : answer.at("traction"))
    write_certified_row(out, "traction q/(mu p0)", " at r/a = " + at.at("radius").get<std::string>(),
                        at.at("value"));
}

}  // namespace slipstick::analytic
