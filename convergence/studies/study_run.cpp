#include "convergence/studies/study_run.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>

#include "convergence/results/provenance.hpp"
#include "convergence/studies/study_judgement.hpp"
#include "solver/input/input_error.hpp"
#include "solver/model/make_model.hpp"
#include "solver/scene/surface_geometry.hpp"

namespace slipstick::convergence {
namespace {

using solver::Index;

/// Rounding is measured on the finest mesh with at most this many cells a side, where it costs little.
constexpr Index kRoundingCells = 128;
/// Cells by which the grids of one mesh grow in all: the contact's edge then moves over the width of two cells.
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
      choice.overrides.push_back(fmt::format("grid.extent=[{}, {}]", unit * grid.h1 * static_cast<double>(grid.n1),
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

/// Times that a study tightens a tolerance by itself, from 1e-8 to 1e-12.
constexpr int kMaxTightenings = 2;

/// The runs of a series to its tolerance, mesh by mesh: its grids, the tightened one, the rounded ones.
std::vector<RunSpec> series_runs(const Study& study, const Series& series) {
  std::vector<RunSpec> runs;
  for (const Mesh& mesh : series.meshes) {
    for (const GridChoice& grid : mesh.grids) runs.push_back(make_run(study, grid, series.tolerance));
    const auto parts = budget_runs(make_run(study, mesh.grids.front(), series.tolerance), series.tolerance);
    runs.insert(runs.end(), parts.begin(), mesh.rounded ? parts.end() : parts.begin() + 1);
  }
  return runs;
}

/// The first `count` results, taken from the front of `found`.
std::vector<Json> take(std::span<const Json>& found, std::size_t count) {
  const auto taken = found.first(count);
  found = found.subspan(count);
  return {taken.begin(), taken.end()};
}

/// The results of series_runs(), taken from the front of `found`.
std::vector<MeshResults> take_series(const Series& series, std::span<const Json>& found) {
  std::vector<MeshResults> results;
  for (const Mesh& mesh : series.meshes) {
    MeshResults& at = results.emplace_back();
    at.grids = take(found, mesh.grids.size());
    at.tightened = take(found, 1).front();
    if (mesh.rounded) at.rounded = take(found, 2);
  }
  return results;
}

/// The runs of a series to the tolerances of the study and to one that is tighter than all, mesh by mesh.
std::vector<RunSpec> tolerance_runs(const Study& study, const Series& series) {
  std::vector<RunSpec> runs;
  for (const Mesh& mesh : series.meshes) {
    for (const double tolerance : study.tolerances) runs.push_back(make_run(study, mesh.grids.front(), tolerance));
    runs.push_back(make_run(study, mesh.grids.front(), kTightening * study.tolerances.back()));
  }
  return runs;
}

/// Solves in parallel and counts the failures.
std::vector<Json> solve_all(const std::vector<RunSpec>& runs, const ProcessPool& pool, FailedRuns& failed) {
  std::vector<Json> results = to_json(pool.run(runs));
  for (std::size_t i = 0; i < runs.size(); ++i) failed.add(run_text(runs[i]), results[i]);
  return results;
}

/// Solves the series, again and to tighter tolerances where the iteration error shows.
std::vector<std::vector<MeshResults>> solve_series(const Study& study, std::vector<Series>& all,
                                                   const ProcessPool& pool, FailedRuns& failed) {
  std::vector<std::vector<MeshResults>> results(all.size());
  std::vector<std::size_t> open(all.size());
  std::iota(open.begin(), open.end(), std::size_t{0});
  for (int pass = 0; !open.empty(); ++pass) {
    std::vector<RunSpec> runs;
    for (const std::size_t i : open) std::ranges::move(series_runs(study, all[i]), std::back_inserter(runs));
    const std::size_t listed_before = pool.lacking();
    const std::vector<Json> solved = solve_all(runs, pool, failed);
    if (pool.lacking() > listed_before) break;
    std::span<const Json> found(solved);
    for (const std::size_t i : open) results[i] = take_series(all[i], found);
    std::erase_if(open, [&](std::size_t i) {
      return pass == kMaxTightenings || all[i].meshes.size() < 2 || !needs_tightening(study, all[i], results[i]);
    });
    for (const std::size_t i : open) {
      all[i].tolerance *= kTightening;
      ++all[i].tightenings;
    }
  }
  return results;
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
    for (const Index across : study.cells) series.meshes.push_back(make_mesh(study, scene, series.overrides, across));
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
  run.stress_error =
      std::ranges::any_of(study.quantities, [](const std::string& path) { return path.starts_with("stress_error"); });
  return run;
}

StudyResult run_study(const Study& study, const ProcessPool& pool) {
  std::vector<Series> all = make_series(study, pool.memory_limit());
  StudyResult result{.name = study.name, .scene = study.scene.string(), .shifts = study.shifts};
  const std::size_t listed_before = pool.lacking();
  const auto results = solve_series(study, all, pool, result.failed_runs);
  const bool is_judged = pool.lacking() == listed_before;
  for (std::size_t i = 0; i < all.size() && is_judged; ++i)
    result.series.push_back(judge_series(study, all[i], results[i]));
  if (study.tolerances.size() > 1) {
    std::vector<RunSpec> runs;
    for (const Series& series : all) std::ranges::move(tolerance_runs(study, series), std::back_inserter(runs));
    const std::vector<Json> solved = solve_all(runs, pool, result.failed_runs);
    std::span<const Json> found(solved);
    for (std::size_t i = 0; i < all.size() && is_judged; ++i) {
      std::vector<std::vector<Json>> by_mesh(all[i].meshes.size());
      for (std::vector<Json>& at : by_mesh) at = take(found, study.tolerances.size() + 1);
      result.series[i].tolerances = tolerance_rows(study, all[i], by_mesh, results[i]);
    }
  }
  result.provenance = provenance(1);
  return result;
}

}  // namespace slipstick::convergence
