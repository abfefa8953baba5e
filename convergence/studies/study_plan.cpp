#include "convergence/studies/study_plan.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/input/input_error.hpp"
#include "solver/model/make_model.hpp"
#include "solver/scene/surface_geometry.hpp"

namespace slipstick::convergence {
namespace {

using solver::Index;

/// Rounding is measured on the finest mesh with at most this many cells a side, where it costs little.
constexpr Index kRoundingCells = 128;
/// Cells by which the grids of one mesh grow in all: the contact's edge then moves over the width of two
/// cells.
constexpr double kShiftCells = 2.0;

/// The grids of a mesh with `across` cells along its longer side, in the shape of the scene's own.
Mesh make_mesh(const Study& study, const solver::Scene& of_series, const std::vector<std::string>& overrides,
               std::optional<Index> across) {
  solver::Scene scene = of_series;
  std::vector<std::string> own = overrides;
  if (across) {
    if (solver::find_height_map(scene.surfaces) != nullptr || !scene.contact.friction.map.empty()) {
      throw solver::InputError(study.source.string(), "cells", std::to_string(*across),
                               "no cells: the scene's height map or friction map gives the grid");
    }
    own.push_back(cells_override(scene, *across));
    scene = solver::read_scene(study.scene, own);
    scene.solver.memory_limit = of_series.solver.memory_limit;
  }
  const solver::Model model = solver::make_model(scene);
  const solver::Grid& grid = model.grid;
  Mesh mesh;
  for (int k = 0; k < study.shifts; ++k) {
    const double longer = static_cast<double>(std::max(grid.n1, grid.n2));
    const double growth = 1.0 + kShiftCells * k / (study.shifts * longer);
    const double unit = growth * model.length_unit;
    GridChoice choice{own, {grid.n1, grid.n2}, unit * std::sqrt(grid.cell_area())};
    if (k > 0) {
      choice.overrides.push_back(fmt::format("grid.extent=[{}, {}]",
                                             unit * grid.h1 * static_cast<double>(grid.n1),
                                             unit * grid.h2 * static_cast<double>(grid.n2)));
    }
    mesh.grids.push_back(std::move(choice));
  }
  return mesh;
}

std::string without_quotes(std::string word) {
  std::erase_if(word, [](char c) { return c == '"' || c == '\''; });
  return word;
}

}  // namespace

std::vector<Series> make_series(const Study& study, std::optional<double> memory_limit) {
  std::vector<Series> all(1);
  all.front().overrides = study.overrides;
  for (const auto& [key, values] : study.variations) {
    std::vector<Series> longer;
    for (const Series& series : all) {
      for (const std::string& value : values) {
        Series next = series;
        const std::string word = without_quotes(value);
        next.name += (next.name.empty() ? "" : "-") + word;
        next.set[key] = Json::parse(value, nullptr, false);
        if (next.set[key].is_discarded()) next.set[key] = word;
        next.overrides.push_back(fmt::format("{}={}", key, value));
        longer.push_back(std::move(next));
      }
    }
    all = std::move(longer);
  }
  for (Series& series : all) {
    solver::Scene scene = solver::read_scene(study.scene, series.overrides);
    scene.solver.memory_limit = memory_limit;
    if (series.name.empty()) series.name = scene.name;
    series.tolerance = study.tolerances.empty() ? scene.solver.tolerance : study.tolerances.back();
    for (const Index across : study.cells)
      series.meshes.push_back(make_mesh(study, scene, series.overrides, across));
    if (study.cells.empty()) series.meshes.push_back(make_mesh(study, scene, series.overrides, std::nullopt));
    Mesh* sample = &series.meshes.front();
    for (Mesh& mesh : series.meshes) {
      if (std::max(mesh.grids[0].cells[0], mesh.grids[0].cells[1]) <= kRoundingCells) sample = &mesh;
    }
    sample->rounded = true;
  }
  return all;
}

RunSpec make_run(const Study& study, const GridChoice& grid, double tolerance) {
  RunSpec run{.scene = study.scene, .overrides = grid.overrides};
  run.overrides.push_back(fmt::format("solver.tolerance={}", tolerance));
  return run;
}

}  // namespace slipstick::convergence
