// Makes the files of proven values that tests and benchmarks compare with: the table, and for each function
// its hardest inputs.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "analytic/certified/hardest.hpp"
#include "analytic/certified/reference_rows.hpp"

namespace slipstick::analytic::certified {

namespace {

using Values = std::vector<double>;
using Inputs = std::map<std::string, Values>;  ///< by the quantity given

const Values kSmall{1e-12, 1e-9, 1e-6, 1e-4, 1e-3, 0.01, 0.05};
const Values kMiddle{0.1, 0.2, 0.3, 0.4, 0.5, 0.53, 0.6, 0.7, 0.8, 0.85, 0.9};
const Values kLarge{0.95, 0.99, 0.994, 0.999, 0.9999, 1 - 1e-6, 1 - 1e-9, 1 - 1e-12};

Values joined(const std::vector<Values>& parts) {
  Values result;
  for (const auto& part : parts) result.insert(result.end(), part.begin(), part.end());
  return result;
}

const Inputs kValues{{"moment_ratio", joined({kSmall, kMiddle, kLarge})},
                     {"moment_deficit", joined({{1e-36, 1e-24, 1e-18}, kSmall, kMiddle, kLarge})},
                     {"stick_ratio", joined({kSmall, kMiddle, kLarge})},
                     {"stick_complement", joined({{1e-30, 1e-18}, kSmall, kMiddle, kLarge})},
                     {"twist", joined({kSmall, kMiddle, {1, 1.5, 2, 3, 5}})}};

/// Both sides of where a flat punch begins to slip, M/M_lim = 8/(3 pi).
const Inputs kFlatPunchValues{
    {"moment_ratio", {0.84, 0.848, 0.8488, 0.84882636, 0.84882637, 0.8489, 0.849, 0.86, 0.87}},
    {"moment_deficit", {0.16, 0.152, 0.1512, 0.15117364, 0.15117363, 0.1511, 0.151, 0.14, 0.13}},
    {"twist", {0.124, 0.1249999, 0.1250001, 0.126, 0.13, 0.15}}};

const Inputs kPowerValues{{"moment_ratio", {1e-6, 0.1, 0.5, 0.9, 0.99}},
                          {"moment_deficit", {1e-12, 1e-4}},
                          {"stick_ratio", {1e-3, 0.3, 0.7, 0.99}},
                          {"stick_complement", {1e-9, 0.01}},
                          {"twist", {1e-3, 0.1, 0.5}}};

/// Where tractions are tabulated: stick radii and, of each, radii inside; beyond it two more.
const Inputs kFronts{{"stick_ratio", {1e-6, 1e-4, 1e-3, 0.01, 0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 0.99, 0.9999}},
                     {"stick_complement", {1e-12, 1e-6}}};
const Inputs kPowerFronts{{"stick_ratio", {1e-3, 0.3, 0.9}}};
const Values kInside{1e-6, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 0.999};

void write_states(std::ostream& out, const std::string& profile, const Inputs& inputs, int digits) {
  for (const auto& [given, values] : inputs)
    for (const double value : values)
      for (const ReferenceRow& row : state_rows(profile, given, value, digits)) out << line(row);
}

void write_tractions(std::ostream& out, const std::string& profile, const Inputs& fronts, int digits) {
  for (const auto& [given, values] : fronts)
    for (const double value : values) {
      const double c = given == "stick_ratio" ? value : 1 - value;
      for (const double inside : kInside)
        out << line(traction_row(profile, given, value, inside * c, digits));
      for (const double beyond : {(1 + c) / 2, 1 - 1e-6})
        if (beyond > c) out << line(traction_row(profile, given, value, beyond, digits));
    }
}

void write_table(const std::string& path, int digits) {
  std::ofstream out(path);
  out << head(fmt::format("slipstick_references table --digits {}", digits));
  for (const std::string profile : {"hertz", "cone", "flat_punch"}) {
    write_states(out, profile, kValues, digits);
    if (profile == "flat_punch") write_states(out, profile, kFlatPunchValues, digits);
    write_tractions(out, profile, kFronts, digits);
  }
  for (const std::string profile : {"power:4", "power:1.5", "power:0.5", "power:8"}) {
    write_states(out, profile, kPowerValues, digits);
    write_tractions(out, profile, kPowerFronts, digits);
  }
  if (!out.flush()) throw std::runtime_error("cannot write " + path);
}

}  // namespace

}  // namespace slipstick::analytic::certified

int main(int argc, char** argv) try {
  using namespace slipstick::analytic::certified;
  CLI::App app("Proven values of the torsional contact, as tests compare with them.");
  app.require_subcommand(1);

  std::string path;
  int digits = 30;
  CLI::App* table = app.add_subcommand("table", "write the table of proven values (minutes)");
  table->add_option("--output", path, "CSV file to write")->required();
  table->add_option("--digits", digits, "significant digits")
      ->check(CLI::Range(15, 50))
      ->capture_default_str();

  Search search;
  CLI::App* hardest = app.add_subcommand(
      "search", "look for inputs harder than those in the files, and add them; no row is ever dropped");
  hardest->add_option("--folder", search.folder, "of the files")->required();
  hardest->add_option("--samples", search.samples, "inputs tried for each function and profile")
      ->capture_default_str();
  hardest->add_option("--seed", search.seed, "of the inputs")->capture_default_str();

  CLI11_PARSE(app, argc, argv);
  if (table->parsed()) write_table(path, digits);
  if (hardest->parsed()) search_hardest(search);
} catch (const std::exception& error) {
  std::fputs((std::string("slipstick_references: ") + error.what() + '\n').c_str(), stderr);
  return 2;
}
