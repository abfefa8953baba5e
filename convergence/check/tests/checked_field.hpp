#pragma once

#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "convergence/check/check.hpp"
#include "convergence/results/exact_result.hpp"
#include "convergence/results/solution_fields.hpp"
#include "solver/input/field_file.hpp"
#include "solver/solve.hpp"

/// Fields as other programs write them, made for a scene, and their checks.
namespace slipstick::convergence {

/// x1, x2, pressure, q1, q2.
using FieldRow = std::array<double, 5>;
using FieldRows = std::vector<FieldRow>;

inline std::filesystem::path temporary_file(const std::string& name) {
  return std::filesystem::path(testing::TempDir()) / name;
}

inline std::filesystem::path write_rows(const FieldRows& rows, int digits = 17,
                                        const std::string& name = "field.csv") {
  const std::filesystem::path file = temporary_file(name);
  std::ofstream stream(file);
  stream << "x1,x2,pressure,q1,q2\n";
  for (const auto& [x1, x2, p, q1, q2] : rows) {
    stream << fmt::format("{0:.{5}e},{1:.{5}e},{2:.{5}e},{3:.{5}e},{4:.{5}e}\n", x1, x2, p, q1, q2,
                          digits - 1);
  }
  return file;
}

/// The contact cells of a solution.
inline FieldRows rows_of(const solver::Solution& solution) {
  const solver::Index cells = solution.grid.cells();
  const Eigen::ArrayXd x1 = solver::cell_x1(solution.grid);
  const Eigen::ArrayXd x2 = solver::cell_x2(solution.grid);
  const Eigen::ArrayXd& p = solution.pressure;
  const Eigen::ArrayXd& q = solution.traction;
  FieldRows rows;
  for (solver::Index i = 0; i < cells; ++i) {
    if (p[i] > 0.0) rows.push_back({x1[i], x2[i], p[i], q[i], q[i + cells]});
  }
  return rows;
}

inline FieldRows read_rows(const std::filesystem::path& file) {
  const auto columns = solver::read_columns(file, {"x1", "x2", "pressure", "q1", "q2"});
  FieldRows rows(static_cast<std::size_t>(columns[0].values.size()));
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (std::size_t c = 0; c < 5; ++c) rows[row][c] = columns[c].values[static_cast<solver::Index>(row)];
  }
  return rows;
}

template <typename Change>
FieldRows changed(FieldRows rows, const Change& change) {
  for (FieldRow& row : rows) change(row);
  return rows;
}

inline FieldRows shuffled(FieldRows rows) {
  std::ranges::shuffle(rows, std::mt19937(1));
  return rows;
}

inline const std::string kScenes = SLIPSTICK_SCENES;
inline const std::string kFields = SLIPSTICK_FIELDS;

inline solver::Scene scene_of(const std::string& name, int cells = 32,
                              std::vector<std::string> overrides = {}) {
  const bool oblong = name == "ellipse";
  overrides.push_back(fmt::format("grid.cells=[{},{}]", cells, oblong ? cells / 2 : cells));
  return solver::read_scene(kScenes + "/" + name + ".toml", overrides);
}

/// A checked field: its result as JSON and text, and the verdict and causes behind the sentences.
struct Checked : Json {
  Verdict verdict;
  std::vector<Cause> causes;
  std::string text;
};
inline void PrintTo(const Checked& result, std::ostream* stream) { *stream << result["why"]; }

inline Checked checked(const solver::Scene& scene, const std::filesystem::path& file,
                       const CheckOptions& options = {}) {
  FieldCheck check = check_field(scene, file, options);
  std::string text = check_text(check);
  return {to_json(check), std::move(check.verdict), std::move(check.explanation.causes), std::move(text)};
}

inline Checked check_rows(const FieldRows& rows, const solver::Scene& scene,
                          std::optional<double> twist = {}) {
  return checked(scene, write_rows(rows), {.twist = twist});
}

/// A judged quantity does not hold.
MATCHER_P(Breaks, quantity, "") { return !arg.verdict.holds(quantity); }

/// The first sentence is about this quantity.
MATCHER_P(BreaksFirst, quantity, "") {
  const auto& judged = arg.verdict.judged;
  const auto first =
      std::ranges::find_if(judged, [](const Judged& item) { return !item.holds() && !item.wrong.empty(); });
  return first != judged.end() && first->quantity == quantity;
}

/// A quantity is off by a signed relative error, in two digits.
MATCHER_P2(IsOff, quantity, error, "") {
  return std::ranges::any_of(arg.verdict.judged, [&](const Judged& item) {
    return item.quantity == quantity && !item.holds() &&
           std::abs((item.low ? -item.value : item.value) - error) <= 0.05 * std::abs(error);
  });
}

/// A cause is named, with its number if one is given, in two digits.
MATCHER_P(Names, cause, "") {
  const Cause& named = cause;
  return std::ranges::any_of(arg.causes, [&](const Cause& each) {
    return each.mistake == named.mistake &&
           !(std::abs(each.found - named.found) > 5e-3 * std::abs(named.found));
  });
}

inline auto names(std::string_view mistake, double found = NAN) { return Names(Cause{mistake, found}); }
inline auto names_none() { return testing::Field(&Checked::causes, testing::IsEmpty()); }

inline FieldRows solved(const solver::Scene& scene) { return rows_of(solver::solve(scene)); }

/// The exact field at cell centres.
inline FieldRows sampled(const solver::Scene& scene) {
  const std::filesystem::path file = temporary_file("exact.h5");
  write_exact_fields(file, scene, require_oracle(scene));
  return read_rows(file);
}

inline Checked check_peer(const std::string& name, std::optional<double> twist = {}) {
  return checked(scene_of("paper"), kFields + "/" + name + "-64-0.9.csv", {.twist = twist});
}

inline std::string why(const Json& result) { return result["why"]; }

inline Checked find_good(const FieldRows& rows, const solver::Scene& scene,
                         std::optional<double> twist = {}) {
  Checked result = check_rows(rows, scene, twist);
  EXPECT_EQ(result["verdict"], "good")
      << scene.name << ", " << scene.grid.cells[0] << " cells: " << why(result);
  return result;
}

inline Checked find_bad(const FieldRows& rows, const solver::Scene& scene,
                        const testing::Matcher<const Checked&>& reason, std::optional<double> twist = {}) {
  Checked result = check_rows(rows, scene, twist);
  EXPECT_EQ(result["verdict"], "bad") << why(result);
  EXPECT_THAT(result, reason);
  return result;
}

inline FieldRows with_tractions_times(const FieldRows& rows, double factor) {
  return changed(rows, [=](FieldRow& r) { r[3] *= factor, r[4] *= factor; });
}

inline FieldRows with_stresses_times(const FieldRows& rows, double factor) {
  return changed(rows, [=](FieldRow& r) { r[2] *= factor, r[3] *= factor, r[4] *= factor; });
}

/// The same rows with some columns in a few digits.
inline FieldRows with_digits(const FieldRows& rows, const std::vector<std::size_t>& columns, int digits) {
  return changed(rows, [&](FieldRow& row) {
    for (const std::size_t c : columns) row[c] = std::stod(fmt::format("{:.{}e}", row[c], digits - 1));
  });
}

/// The item of result["judged"] for a quantity.
inline Json judgement(const Json& result, const std::string& quantity) {
  for (const Json& item : result["judged"]) {
    if (item["quantity"] == quantity) return item;
  }
  ADD_FAILURE() << "nothing is said of " << quantity;
  return {};
}

inline double allowed(const Json& result, const std::string& quantity) {
  return judgement(result, quantity)["allowed"];
}

}  // namespace slipstick::convergence
