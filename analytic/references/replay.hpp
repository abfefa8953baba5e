#pragma once

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "analytic/named_profile.hpp"
#include "analytic/references/references.hpp"
#include "analytic/torsion.hpp"

/// Double precision against rows of proven references.
namespace slipstick::analytic::testing {

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
    for (Row& row : read_references("hardest/" + file.path().filename().string()))
      rows.push_back(std::move(row));
  return rows;
}

}  // namespace slipstick::analytic::testing
