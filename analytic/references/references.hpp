#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "analytic/named_profile.hpp"
#include "analytic/torsion.hpp"

/// Tables of proven references, and double precision against their rows.
namespace slipstick::analytic::testing {

/// One row of a reference table, by column.
struct Row {
  const std::string& text(const std::string& column) const { return cells.at(column); }
  /// Beyond double precision, so that the reference's own rounding does not count as an error.
  long double number(const std::string& column) const { return std::strtold(text(column).c_str(), nullptr); }
  double argument(const std::string& column) const { return std::strtod(text(column).c_str(), nullptr); }

  std::string line;
  std::map<std::string, std::string> cells = {};
};

/// The rows of a CSV file of this folder, with a comment line and the column names above them.
inline std::vector<Row> read_references(const std::string& name) {
  std::ifstream file(std::string(SLIPSTICK_REFERENCES) + "/" + name);
  std::string about, header;
  std::getline(file, about);
  std::getline(file, header);
  std::vector<Row> rows;
  for (std::string line; std::getline(file, line);) {
    Row& row = rows.emplace_back(Row{line});
    std::istringstream columns(header), cells(line);
    for (std::string column, cell; std::getline(columns, column, ',') && std::getline(cells, cell, ',');)
      row.cells[column] = cell;
  }
  if (rows.empty()) throw std::runtime_error("no reference rows in " + name);
  return rows;
}

/// |value / reference - 1|; a NaN stays one.
inline double relative_error(double value, long double reference) {
  const long double error = (static_cast<long double>(value) - reference) / reference;
  return static_cast<double>(error < 0 ? -error : error);
}

inline const std::map<std::string, TorsionState (*)(double, const Profile&)> kFrom{
    {"moment_ratio", from_moment_ratio},
    {"moment_deficit", from_moment_deficit},
    {"stick_ratio", from_stick_ratio},
    {"stick_complement", from_stick_complement},
    {"twist", from_twist}};

inline const std::map<std::string, double TorsionState::*> kMember{
    {"moment_ratio", &TorsionState::moment_ratio},
    {"moment_deficit", &TorsionState::moment_deficit},
    {"stick_ratio", &TorsionState::stick_ratio},
    {"stick_complement", &TorsionState::stick_complement},
    {"twist", &TorsionState::twist}};

constexpr double kEps = std::numeric_limits<double>::epsilon();
constexpr double kAllowed = 8;    ///< eps, where the input costs no digits
constexpr double kOfTheCost = 4;  ///< times what one ulp of the input costs, where that is more

/// In units of eps: the error, and the allowed error: 8, or 4 times the change by one ulp of the input.
struct Replay {
  double error;
  double allowed;
};

inline double computed(const Profile& profile, const Row& row) {
  const TorsionState state = kFrom.at(row.text("given"))(row.argument("value"), profile);
  const std::string& quantity = row.text("quantity");
  return quantity == "traction" ? traction(state, row.argument("at"), profile) : state.*kMember.at(quantity);
}

inline double error_in_eps(double value, const Row& row) {
  const long double reference = row.number("reference");
  if (reference == 0) return value == 0 ? 0 : std::numeric_limits<double>::infinity();
  return relative_error(value, reference) / kEps;
}

/// A row as proven_references.py writes them: profile, given, value, quantity, at, reference, bound, cost.
inline Replay replay(const Row& row) {
  static std::map<std::string, NamedProfile> profiles;
  const std::string& name = row.text("profile");
  if (!profiles.contains(name)) profiles.emplace(name, find_profile(name));
  return {.error = error_in_eps(computed(*profiles.at(name).profile, row), row),
          .allowed = std::max(kAllowed, kOfTheCost * row.argument("cost"))};
}

/// The certified table, and the hardest inputs known of each function.
inline std::vector<Row> all_references() {
  std::vector<Row> rows = read_references("certified_references.csv");
  for (const auto& file : std::filesystem::directory_iterator(std::string(SLIPSTICK_REFERENCES) + "/hardest"))
    for (Row& row : read_references("hardest/" + file.path().filename().string())) rows.push_back(std::move(row));
  return rows;
}

}  // namespace slipstick::analytic::testing
