#include "convergence/check/loop_request.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "analytic/axisymmetric.hpp"
#include "convergence/oracle/exact_theories.hpp"
#include "convergence/oracle/law_contact.hpp"
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

/// Rows of a loop: fewer do not show its noise.
constexpr std::size_t kMinLoopRows = 20;

/// Moment and rotation, or tangential force and displacement, row by row in the units of the program that wrote them.
struct LoopRecord {
  std::filesystem::path file;
  bool of_force;
  std::vector<double> time;  ///< empty: not given
  std::vector<double> load;
  std::vector<double> motion;
  std::vector<double> normal_load;  ///< empty: not given
};

/// Consecutive rows under one normal load.
struct LoadRows {
  std::size_t from;
  std::size_t to;
  double normal_load;  ///< N
};

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

std::vector<double> csv_column(const std::filesystem::path& file, const std::string& name) {
  const Eigen::ArrayXd values = solver::read_columns(file, {name}).front().values;
  return {values.begin(), values.end()};
}

std::vector<double> json_list(const std::filesystem::path& file, const Json& json, const std::string& name) {
  const Json& list = json[name];
  const bool are_numbers = list.is_array() && std::ranges::all_of(list, [](const Json& v) { return v.is_number(); });
  if (!are_numbers) throw InputError(file.string(), name, "...", "a list of numbers");
  return list.get<std::vector<double>>();
}

template <class Column>
LoopRecord collect(const std::filesystem::path& file, const std::vector<std::string>& there, const Column& column) {
  const auto required = [&](const std::vector<std::string>& names) {
    const std::string name = present(there, names);
    if (name.empty()) {
      throw InputError(file.string(),
                       fmt::format("has no {}; allowed names: {}; it has: {}", names.front(), fmt::join(names, ", "),
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
      throw InputError(file,
                       fmt::format("its lists have {} and {} values; allowed: equally many", rows, column->size()));
    }
  }
  if (rows < kMinLoopRows) {
    throw InputError(file, fmt::format("{} rows are too few for a loop; allowed: at least {}", rows, kMinLoopRows));
  }
  for (std::size_t row = 1; row < loop.time.size(); ++row) {
    if (!(loop.time[row] > loop.time[row - 1])) {
      throw InputError(file,
                       fmt::format("row {}: time = {}; allowed: later than the row before", row + 1, loop.time[row]));
    }
  }
  for (std::size_t row = 0; row < loop.normal_load.size(); ++row) {
    if (!(loop.normal_load[row] > 0.0)) {
      throw InputError(
          file, fmt::format("row {}: normal_load = {}; allowed: larger than zero", row + 1, loop.normal_load[row]));
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

/// Reads a CSV table, or JSON lists of the same names.
LoopRecord read_loop(const std::filesystem::path& file) {
  solver::require_input_file(file, solver::kLargestTextTable, "a loop (CSV or JSON)");
  LoopRecord loop = file.extension() == ".json"
                        ? read_json_loop(file)
                        : collect(file, solver::text_table_names(file),
                                  [&](const std::string& name) { return csv_column(file, name); });
  require_sound(loop);
  return loop;
}

/// The rows under each normal load, all under the scene's load if the record names none.
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
    throw InputError(
        loop.file.string(),
        fmt::format("rows {} to {}: normal_load = {} for {} rows; allowed: loops one after another, each under a "
                    "load of its own for at least {} rows",
                    group.from + 1, group.to, group.normal_load, group.to - group.from, kMinLoopRows));
  }
  return groups;
}

solver::Scene under(const solver::Scene& scene, double normal_load) {
  solver::Scene other = scene;
  other.steps.front().normal = normal_load;
  return other;
}

/// d ln(contact radius)/d ln(normal load).
double radius_exponent(const solver::Scene& scene, const LawUnits& units) {
  constexpr double kMore = 1.001;
  const double larger = law_contact(under(scene, kMore * units.normal_load)).units->contact_radius;
  return std::log(larger / units.contact_radius) / std::log(kMore);
}

double gap_exponent(const solver::Scene& scene) {
  const std::optional<ExactShape> shape = exact_shape(scene.surfaces.front());
  if (shape && shape->gap_exponent) return *shape->gap_exponent;
  throw InputError(scene.source.string(),
                   "its contact does not stay similar to itself as the load changes: there is no law "
                   "of forces; allowed: sphere, cone, flat_punch, power");
}

/// The contact under a normal load, with the numbers of both kinds of loops: the load's unit is the limit,
/// and the motion's mu W/(G a^2) in torsion; under a force mu W/(G_t a), with 1/G_t = sum of (2 - nu)/(2 G).
/// one_body: the stiffness with the other body rigid, over the pair's. A force has Cattaneo's and Mindlin's
/// law, which is exact for Poisson's ratios of 0 and otherwise neglects slip across the force.
Json contact_json(const solver::Scene& scene, double normal_load, bool of_force) {
  const solver::Scene loaded = under(scene, normal_load);
  const LawContact contact = law_contact(loaded);
  const LawUnits& units = *contact.units;
  const auto compliance = [&](const solver::Material& body) {
    const double shear = (1.0 + body.poisson_ratio) / body.young_modulus;
    return of_force ? (2.0 - body.poisson_ratio) * shear : shear;
  };
  const double pair = compliance(scene.upper) + compliance(scene.lower);
  Json json{{"normal_load", normal_load},
            {"radius_exponent", radius_exponent(loaded, units)},
            {"one_body", {pair / compliance(scene.upper), pair / compliance(scene.lower)}}};
  if (of_force) {
    const double limit = units.friction * normal_load;
    json.update({{"limit", limit}, {"motion_unit", limit * pair / units.contact_radius}, {"gap", gap_exponent(scene)}});
    return json;
  }
  json.update({{"limit", contact.profile->moment_limit() * units.moment()},
               {"motion_unit", units.rotation()},
               {"profile", contact.profile->name()}});
  return json;
}

}  // namespace

bool is_loop_file(const std::filesystem::path& file) {
  if (file.extension() == ".json") return true;
  const std::vector<std::string> text{".csv", ".txt", ".dat", ".tsv"};
  if (present({file.extension().string()}, text).empty() || !std::filesystem::is_regular_file(file)) return false;
  const std::vector<std::string> names = solver::text_table_names(file);
  const bool is_field = !present(names, {"x1"}).empty();
  const bool of_torsion = !present(names, kMomentNames).empty() && !present(names, kRotationNames).empty();
  return !is_field && (of_torsion || is_of_force(names));
}

Json loop_request(const solver::Scene& scene, const std::filesystem::path& file, const CheckOptions& options) {
  law_contact(scene);  // or why there is none, before the loop is read
  const LoopRecord record = read_loop(file);
  Json groups = Json::array();
  for (const LoadRows& group : rows_by_load(record, *scene.steps.front().normal)) {
    Json& json = groups.emplace_back(contact_json(scene, group.normal_load, record.of_force));
    json["rows"] = {group.from, group.to};
  }
  return {{"name", scene.name},
          {"loop", file.string()},
          {"of_force", record.of_force},
          {"tolerance", options.tolerance.value_or(0.01)},
          {"strict", options.strict},
          {"time", record.time},
          {"load", record.load},
          {"motion", record.motion},
          {"groups", groups}};
}

}  // namespace slipstick::convergence
