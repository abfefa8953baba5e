#include "convergence/check/loops/loop_record.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "convergence/results/json_text.hpp"
#include "solver/input/field_file.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/input_file.hpp"
#include "solver/input/table_text.hpp"

namespace slipstick::convergence {
namespace {

using solver::InputError;

const std::vector<std::string> kMomentNames{"moment", "torque"};
const std::vector<std::string> kRotationNames{"rotation", "twist", "angle", "twist_angle"};
const std::vector<std::string> kForceNames{"force", "tangential_force"};
const std::vector<std::string> kDisplacementNames{"displacement"};
const std::vector<std::string> kTimeNames{"time", "t"};
const std::vector<std::string> kLoadNames{"normal_load", "normal_force"};

/// The first of these names that is present; empty: none.
std::string present(const std::vector<std::string>& there, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (std::ranges::find(there, name) != there.end()) return name;
  }
  return "";
}

/// Whether there are forces and displacements, and no moments.
bool is_of_force(const std::vector<std::string>& there) {
  return present(there, kMomentNames).empty() && !present(there, kForceNames).empty() &&
         !present(there, kDisplacementNames).empty();
}

/// The names in the table's header, in small letters.
std::vector<std::string> table_names(const std::filesystem::path& file) {
  std::vector<std::string> names = solver::text_table_names(file);
  for (std::string& name : names) {
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  }
  return names;
}

std::vector<double> csv_column(const std::filesystem::path& file, const std::string& name) {
  const Eigen::ArrayXd values = solver::read_columns(file, {name}).front().values;
  return {values.begin(), values.end()};
}

std::vector<double> json_list(const std::filesystem::path& file, const Json& json, const std::string& name) {
  std::vector<double> values;
  const Json& list = json[name];
  const bool are_numbers =
      list.is_array() && std::ranges::all_of(list, [](const Json& v) { return v.is_number(); });
  if (!are_numbers) throw InputError(file.string(), name, "...", "a list of numbers");
  for (const Json& value : list) values.push_back(value.get<double>());
  return values;
}

template <class Column>
LoopRecord collect(const std::filesystem::path& file, const std::vector<std::string>& there,
                   const Column& column) {
  const auto required = [&](const std::vector<std::string>& names) {
    const std::string name = present(there, names);
    if (name.empty()) {
      throw InputError(file.string(), fmt::format("has no {}; allowed names: {}; it has: {}", names.front(),
                                                  fmt::join(names, ", "),
                                                  solver::shown(fmt::format("{}", fmt::join(there, ", ")))));
    }
    return column(name);
  };
  const auto optional = [&](const std::vector<std::string>& names) {
    const std::string name = present(there, names);
    return name.empty() ? std::vector<double>() : column(name);
  };
  const bool of_force = is_of_force(there);
  return {file,
          of_force,
          optional(kTimeNames),
          required(of_force ? kForceNames : kMomentNames),
          required(of_force ? kDisplacementNames : kRotationNames),
          optional(kLoadNames)};
}

LoopRecord read_json_loop(const std::filesystem::path& file) {
  const Json json = read_json(file, "a loop (JSON)");
  std::vector<std::string> names;
  if (json.is_object()) {
    for (const auto& item : json.items()) names.push_back(item.key());
  }
  return collect(file, names, [&](const std::string& name) { return json_list(file, json, name); });
}

void require_sound(const LoopRecord& loop) {
  const std::string file = loop.file.string();
  const std::size_t rows = loop.load.size();
  for (const std::vector<double>* column : {&loop.motion, &loop.time, &loop.normal_load}) {
    if (!column->empty() && column->size() != rows) {
      throw InputError(
          file, fmt::format("its lists have {} and {} values; allowed: equally many", rows, column->size()));
    }
  }
  if (rows < kMinLoopRows) {
    throw InputError(file,
                     fmt::format("{} rows are too few for a loop; allowed: at least {}", rows, kMinLoopRows));
  }
  for (std::size_t row = 1; row < loop.time.size(); ++row) {
    if (!(loop.time[row] > loop.time[row - 1])) {
      throw InputError(file, fmt::format("row {}: time = {}; allowed: later than the row before", row + 1,
                                         loop.time[row]));
    }
  }
  for (std::size_t row = 0; row < loop.normal_load.size(); ++row) {
    if (!(loop.normal_load[row] > 0.0)) {
      throw InputError(file, fmt::format("row {}: normal_load = {}; allowed: larger than zero", row + 1,
                                         loop.normal_load[row]));
    }
  }
  const auto is_constant = [](const std::vector<double>& values) {
    return std::ranges::all_of(values, [&](double value) { return value == values.front(); });
  };
  if (is_constant(loop.load) || is_constant(loop.motion)) {
    throw InputError(file, "load or motion never changes: there is no loop to judge");
  }
  constexpr double kLargest = 1e100;  // in any unit; the fit squares values
  for (const std::vector<double>* column : {&loop.load, &loop.motion, &loop.time, &loop.normal_load}) {
    double size = column->empty() ? 1.0 : 0.0;
    for (const double value : *column) size = std::max(size, std::abs(value));
    if (!(size > 1.0 / kLargest && size < kLargest)) {
      throw InputError(file, fmt::format("a column reaches {:g}; allowed: sizes within 1e-100..1e100", size));
    }
  }
}

}  // namespace

bool is_loop_file(const std::filesystem::path& file) {
  if (file.extension() == ".json") return true;
  const std::vector<std::string> text{".csv", ".txt", ".dat", ".tsv"};
  if (present({file.extension().string()}, text).empty() || !std::filesystem::is_regular_file(file))
    return false;
  const std::vector<std::string> names = table_names(file);
  const bool is_field = !present(names, {"x1"}).empty();
  const bool of_torsion = !present(names, kMomentNames).empty() && !present(names, kRotationNames).empty();
  return !is_field && (of_torsion || is_of_force(names));
}

LoopRecord read_loop(const std::filesystem::path& file) {
  solver::require_input_file(file, solver::kLargestTextTable, "a loop (CSV or JSON)");
  LoopRecord loop =
      file.extension() == ".json"
          ? read_json_loop(file)
          : collect(file, table_names(file), [&](const std::string& name) { return csv_column(file, name); });
  require_sound(loop);
  return loop;
}

std::vector<LoadRows> rows_by_load(const LoopRecord& loop, double scene_load) {
  constexpr double kSameLoad = 0.02;  // relative difference of rows under one load
  if (loop.normal_load.empty()) return {{0, loop.load.size(), scene_load}};
  std::vector<LoadRows> groups{{0, 1, loop.normal_load[0]}};
  for (std::size_t row = 1; row < loop.normal_load.size(); ++row) {
    if (std::abs(loop.normal_load[row] / groups.back().normal_load - 1.0) > kSameLoad) {
      groups.push_back({row, row, loop.normal_load[row]});
    }
    groups.back().to = row + 1;
  }
  for (const LoadRows& group : groups) {
    if (group.to - group.from >= kMinLoopRows) continue;
    throw solver::InputError(
        loop.file.string(),
        fmt::format(
            "rows {} to {}: normal_load = {} for {} rows; allowed: loops one after another, each under a "
            "load of its own for at least {} rows",
            group.from + 1, group.to, group.normal_load, group.to - group.from, kMinLoopRows));
  }
  return groups;
}

}  // namespace slipstick::convergence
