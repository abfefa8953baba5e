#include "convergence/solve/measured_accuracy.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "accuracy_text.hpp"

namespace slipstick::convergence {
namespace {

/// y at x on the line through two points, all in logarithms.
double power_between(double x, double x1, double y1, double x2, double y2) {
  const double slope = std::log(y2 / y1) / std::log(x2 / x1);
  return y1 * std::pow(x / x1, slope);
}

double value_in(const toml::node_view<const toml::node>& node) { return node.value<double>().value(); }

std::vector<double> values_in(const toml::node_view<const toml::node>& list) {
  std::vector<double> values;
  for (const toml::node& value : *list.as_array()) values.push_back(value.value<double>().value());
  return values;
}

MeasuredMesh mesh_of(const toml::table& table) {
  MeasuredMesh mesh{.cells_across = value_in(table["cells_across"]),
                    .errors = {},
                    .tolerances = values_in(table["tolerances"]),
                    .work = values_in(table["work"])};
  for (const auto& [word, of] : accuracy_words()) {
    mesh.errors[static_cast<std::size_t>(of)] = {value_in(table[word]["error"]), value_in(table[word]["tolerance"])};
  }
  return mesh;
}

const MeasuredError& at(const MeasuredMesh& mesh, AccuracyOf of) { return mesh.errors[static_cast<std::size_t>(of)]; }

/// The two neighbouring meshes between which to interpolate, the finer one last.
template <typename Reached>
std::pair<const MeasuredMesh&, const MeasuredMesh&> neighbours(const AccuracyData& data, Reached reached) {
  std::size_t i = 1;
  while (i + 1 < data.meshes.size() && !reached(data.meshes[i])) ++i;
  return {data.meshes[i - 1], data.meshes[i]};
}

/// Work on one mesh, linear in log(tolerance) between its tolerances: iterations gain digits at a constant rate.
double work_on(const MeasuredMesh& mesh, double tolerance) {
  const auto& t = mesh.tolerances;
  if (tolerance >= t.front()) return mesh.work.front();
  for (std::size_t i = 1; i < t.size(); ++i) {
    if (tolerance < t[i]) continue;
    const double part = std::log(tolerance / t[i - 1]) / std::log(t[i] / t[i - 1]);
    return mesh.work[i - 1] + part * (mesh.work[i] - mesh.work[i - 1]);
  }
  return mesh.work.back();
}

}  // namespace

const solver::Words<AccuracyOf>& accuracy_words() {
  static const solver::Words<AccuracyOf> words{
      {"twist", AccuracyOf::twist}, {"traction", AccuracyOf::traction}, {"stick_radius", AccuracyOf::stick_radius}};
  return words;
}

AccuracyData accuracy_data() {
  const toml::table root = toml::parse(kAccuracyText);
  AccuracyData data;
  for (const toml::node& mesh : *root["mesh"].as_array()) data.meshes.push_back(mesh_of(*mesh.as_table()));
  return data;
}

Needed needed_for(const AccuracyData& data, AccuracyOf of, double error) {
  const MeasuredMesh& coarsest = data.meshes.front();
  const MeasuredMesh& finest = data.meshes.back();
  if (error >= at(coarsest, of).error) return {coarsest.cells_across, at(coarsest, of).tolerance};
  if (error < at(finest, of).error) {
    const double finer = std::pow(at(finest, of).error / error, 1.0 / falling_order(data, of));
    // The tolerance falls in proportion to the error.
    return {finest.cells_across * finer, at(finest, of).tolerance * error / at(finest, of).error};
  }
  const auto [coarse, fine] = neighbours(data, [&](const MeasuredMesh& mesh) { return at(mesh, of).error <= error; });
  return {power_between(error, at(coarse, of).error, coarse.cells_across, at(fine, of).error, fine.cells_across),
          at(fine, of).tolerance};
}

double error_with(const AccuracyData& data, AccuracyOf of, double across) {
  const MeasuredMesh& finest = data.meshes.back();
  if (across <= data.meshes.front().cells_across) return at(data.meshes.front(), of).error;
  if (across > finest.cells_across) {
    return at(finest, of).error * std::pow(finest.cells_across / across, falling_order(data, of));
  }
  const auto [coarse, fine] = neighbours(data, [&](const MeasuredMesh& mesh) { return mesh.cells_across >= across; });
  return power_between(across, coarse.cells_across, at(coarse, of).error, fine.cells_across, at(fine, of).error);
}

double falling_order(const AccuracyData& data, AccuracyOf of) {
  // From the third finest mesh, if there is one: errors of neighbouring meshes scatter.
  const std::size_t back = std::min<std::size_t>(data.meshes.size(), 3);
  const MeasuredMesh& coarse = data.meshes[data.meshes.size() - back];
  const MeasuredMesh& fine = data.meshes.back();
  return std::log(at(coarse, of).error / at(fine, of).error) / std::log(fine.cells_across / coarse.cells_across);
}

double work_of(const AccuracyData& data, double across, double tolerance) {
  const auto [coarse, fine] = neighbours(data, [&](const MeasuredMesh& mesh) { return mesh.cells_across >= across; });
  if (across <= coarse.cells_across) return work_on(coarse, tolerance);
  return power_between(across, coarse.cells_across, work_on(coarse, tolerance), fine.cells_across,
                       work_on(fine, tolerance));
}

}  // namespace slipstick::convergence
