#include "convergence/solve/measured_accuracy.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "accuracy_text.hpp"

namespace slipstick::convergence {
namespace {

/// Version of the file's layout.
constexpr int kVersion = 1;

/// y at x on the line through two points, all in logarithms.
double power_between(double x, double x1, double y1, double x2, double y2) {
  const double slope = std::log(y2 / y1) / std::log(x2 / x1);
  return y1 * std::pow(x / x1, slope);
}

double positive(const toml::table& table, const std::string& key) {
  const auto value = table[key].value<double>();
  if (!value || !(*value > 0.0))
    throw std::runtime_error(fmt::format("accuracy data: {}: not positive", key));
  return *value;
}

std::vector<double> positive_list(const toml::table& table, const std::string& key) {
  std::vector<double> values;
  const toml::array* const array = table[key].as_array();
  for (std::size_t i = 0; array != nullptr && i < array->size(); ++i) {
    values.push_back((*array)[i].value<double>().value_or(NAN));
    if (!(values.back() > 0.0)) throw std::runtime_error(fmt::format("accuracy data: {}: not positive", key));
  }
  if (values.empty()) throw std::runtime_error(fmt::format("accuracy data: {} is missing", key));
  return values;
}

MeasuredMesh parse_mesh(const toml::table& table) {
  MeasuredMesh mesh{.cells_across = positive(table, "cells_across"),
                    .errors = {},
                    .tolerances = positive_list(table, "tolerances"),
                    .applications = positive_list(table, "applications"),
                    .work = positive_list(table, "work")};
  for (const auto& [word, of] : accuracy_words()) {
    const toml::table* const error = table[word].as_table();
    if (error == nullptr) throw std::runtime_error(fmt::format("accuracy data: {} is missing", word));
    mesh.errors[static_cast<std::size_t>(of)] = {positive(*error, "error"), positive(*error, "tolerance")};
  }
  if (mesh.applications.size() != mesh.tolerances.size() || mesh.work.size() != mesh.tolerances.size() ||
      !std::is_sorted(mesh.tolerances.rbegin(), mesh.tolerances.rend())) {
    throw std::runtime_error("accuracy data: tolerances must fall, each with its applications and work");
  }
  return mesh;
}

const MeasuredError& at(const MeasuredMesh& mesh, AccuracyOf of) {
  return mesh.errors[static_cast<std::size_t>(of)];
}

void require_falling(const AccuracyData& data) {
  if (data.meshes.size() < 2) throw std::runtime_error("accuracy data: fewer than two meshes");
  for (std::size_t i = 1; i < data.meshes.size(); ++i) {
    const MeasuredMesh& coarse = data.meshes[i - 1];
    const MeasuredMesh& fine = data.meshes[i];
    bool falls = coarse.cells_across < fine.cells_across;
    for (std::size_t q = 0; q < kAccuracies; ++q) {
      falls = falls && fine.errors[q].error <= coarse.errors[q].error &&
              fine.errors[q].tolerance <= coarse.errors[q].tolerance;
    }
    if (!falls)
      throw std::runtime_error("accuracy data: meshes must become finer, errors and tolerances fall");
  }
  // Else nothing could be said beyond the finest mesh.
  for (const auto& [word, of] : accuracy_words()) {
    if (!(falling_order(data, of) > 0.0)) {
      throw std::runtime_error(
          fmt::format("accuracy data: the error of the {} does not fall in the end", word));
    }
  }
}

/// The pair of neighbouring meshes to interpolate between, by the place of the finer one.
template <typename Reached>
std::size_t finer_of_pair(const AccuracyData& data, Reached reached) {
  std::size_t i = 1;
  while (i + 1 < data.meshes.size() && !reached(data.meshes[i])) ++i;
  return i;
}

/// Work on one mesh; between its tolerances linear in their logarithm, as the digits that iterations gain.
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

std::string list_text(const std::vector<double>& values) {
  std::vector<std::string> words;
  for (const double value : values) words.push_back(fmt::format("{:.4g}", value));
  return fmt::format("[{}]", fmt::join(words, ", "));
}

}  // namespace

const solver::Words<AccuracyOf>& accuracy_words() {
  static const solver::Words<AccuracyOf> words{{"twist", AccuracyOf::twist},
                                               {"traction", AccuracyOf::traction},
                                               {"stick_radius", AccuracyOf::stick_radius}};
  return words;
}

AccuracyData accuracy_data() { return parse_accuracy_data(kAccuracyText); }

AccuracyData parse_accuracy_data(const std::string& text) {
  toml::table root;
  try {
    root = toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw std::runtime_error(fmt::format("accuracy data: {}", error.description()));
  }
  if (root["version"].value<int>() != kVersion) {
    throw std::runtime_error(fmt::format("accuracy data: the version is not {}", kVersion));
  }
  AccuracyData data;
  const toml::array* const meshes = root["mesh"].as_array();
  for (std::size_t i = 0; meshes != nullptr && i < meshes->size(); ++i) {
    const toml::table* const table = (*meshes)[i].as_table();
    if (table == nullptr) throw std::runtime_error("accuracy data: a mesh is no table");
    data.meshes.push_back(parse_mesh(*table));
  }
  require_falling(data);
  return data;
}

std::string accuracy_toml(const AccuracyData& data, const std::string& origin) {
  std::string text = fmt::format(
      "# Errors of smooth contacts in torsion, and what solves cost; what `slipstick solve --accuracy` picks "
      "by.\n# {}\n# cells_across: the contact's diameter over a cell's side. error: relative, the largest "
      "over "
      "the loads and over\n# finer meshes. tolerance: the loosest that changes it by at most a tenth. "
      "applications, work: at each of the\n# tolerances, the most over the loads; work is the seconds of a "
      "whole solve over those of one application on\n# 64 x 64 cells.\nversion = {}\n",
      origin, kVersion);
  for (const MeasuredMesh& mesh : data.meshes) {
    text += fmt::format("\n[[mesh]]\ncells_across = {:.5g}\n", mesh.cells_across);
    for (const auto& [word, of] : accuracy_words()) {
      text += fmt::format("{} = {{ error = {:.3g}, tolerance = {:g} }}\n", word, at(mesh, of).error,
                          at(mesh, of).tolerance);
    }
    text += fmt::format("tolerances = {}\napplications = {}\nwork = {}\n", list_text(mesh.tolerances),
                        list_text(mesh.applications), list_text(mesh.work));
  }
  return text;
}

Needed needed_for(const AccuracyData& data, AccuracyOf of, double error) {
  const MeasuredMesh& coarsest = data.meshes.front();
  const MeasuredMesh& finest = data.meshes.back();
  if (error >= at(coarsest, of).error) return {coarsest.cells_across, at(coarsest, of).tolerance};
  if (error < at(finest, of).error) {
    const double finer = std::pow(at(finest, of).error / error, 1.0 / falling_order(data, of));
    // What the iteration may leave falls as what the mesh leaves.
    return {finest.cells_across * finer, at(finest, of).tolerance * error / at(finest, of).error};
  }
  const std::size_t i =
      finer_of_pair(data, [&](const MeasuredMesh& mesh) { return at(mesh, of).error <= error; });
  const MeasuredMesh& coarse = data.meshes[i - 1];
  const MeasuredMesh& fine = data.meshes[i];
  return {
      power_between(error, at(coarse, of).error, coarse.cells_across, at(fine, of).error, fine.cells_across),
      at(fine, of).tolerance};
}

double error_with(const AccuracyData& data, AccuracyOf of, double across) {
  const MeasuredMesh& finest = data.meshes.back();
  if (across <= data.meshes.front().cells_across) return at(data.meshes.front(), of).error;
  if (across > finest.cells_across) {
    return at(finest, of).error * std::pow(finest.cells_across / across, falling_order(data, of));
  }
  const std::size_t i =
      finer_of_pair(data, [&](const MeasuredMesh& mesh) { return mesh.cells_across >= across; });
  const MeasuredMesh& coarse = data.meshes[i - 1];
  const MeasuredMesh& fine = data.meshes[i];
  return power_between(across, coarse.cells_across, at(coarse, of).error, fine.cells_across,
                       at(fine, of).error);
}

double falling_order(const AccuracyData& data, AccuracyOf of) {
  // Two meshes apart where there are so many: neighbours' errors scatter.
  const std::size_t back = std::min<std::size_t>(data.meshes.size(), 3);
  const MeasuredMesh& coarse = data.meshes[data.meshes.size() - back];
  const MeasuredMesh& fine = data.meshes.back();
  return std::log(at(coarse, of).error / at(fine, of).error) /
         std::log(fine.cells_across / coarse.cells_across);
}

double work_of(const AccuracyData& data, double across, double tolerance) {
  const std::size_t i =
      finer_of_pair(data, [&](const MeasuredMesh& mesh) { return mesh.cells_across >= across; });
  const MeasuredMesh& coarse = data.meshes[i - 1];
  const MeasuredMesh& fine = data.meshes[i];
  if (across <= coarse.cells_across) return work_on(coarse, tolerance);
  return power_between(across, coarse.cells_across, work_on(coarse, tolerance), fine.cells_across,
                       work_on(fine, tolerance));
}

}  // namespace slipstick::convergence
