#include "bench/plane/speed_error.hpp"

#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "bench/timing/checked_solve.hpp"
#include "convergence/programs/package_module.hpp"
#include "convergence/results/exact_result.hpp"
#include "convergence/results/provenance.hpp"
#include "convergence/runs/path_uncertainty.hpp"
#include "convergence/runs/result_cache.hpp"
#include "convergence/runs/run_spec.hpp"
#include "convergence/solve/plan.hpp"
#include "convergence/studies/study_run.hpp"
#include "solver/model/make_model.hpp"

namespace slipstick::bench {
namespace {

using convergence::Errors;
using convergence::set_missing;
using convergence::set_number;
using solver::Index;

/// Cells along a side of the grid on which the exact side gives tractions.
constexpr Index kExactCells = 128;

/// The quantities of the plane.
std::map<std::string, double> values(const Errors& errors) {
  return {{"twist", errors.twist},
          {"traction_l1", errors.traction.at_centres.l1},
          {"traction_l2", errors.traction.at_centres.l2},
          {"stick_radius", errors.stick_radius}};
}

/// Work that returns its own seconds is repeated at least kMinRepetitions times, then until kMaxRepetitions
/// or until kEnoughSeconds have passed.
constexpr std::size_t kMinRepetitions = 3;
constexpr std::size_t kMaxRepetitions = 9;
constexpr double kEnoughSeconds = 1.0;

/// Each repetition's seconds.
Json repeated_seconds(const std::function<double()>& work) {
  std::vector<double> seconds;
  double total = 0.0;
  while (seconds.size() < kMinRepetitions || (seconds.size() < kMaxRepetitions && total < kEnoughSeconds)) {
    seconds.push_back(work());
    total += seconds.back();
  }
  return seconds;
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// errors: of each quantity, of each grid.
void add_errors(Json& json, const std::map<std::string, std::vector<double>>& errors) {
  for (const auto& [name, of_grids] : errors) {
    set_number(json["error"], name, root_mean_square(of_grids), "a grid's error is not a number");
    for (const double error : of_grids) {
      json["errors"][name].push_back(std::isfinite(error) ? Json(error) : Json(nullptr));
    }
  }
}

std::vector<std::string> overrides_of(const Json& run) { return run.at("overrides"); }

std::vector<convergence::GridChoice> grids(const std::filesystem::path& scene, const Json& run) {
  convergence::Study study;
  study.source = study.scene = scene;
  study.overrides = overrides_of(run);
  study.cells = {run.at("choice").at("cells").get<Index>()};
  study.shifts = run.at("grids");
  return convergence::make_series(study).front().meshes.front().grids;
}

/// The whole exact answer: stick radius and twist from the load, then tractions in the cells of a grid.
Json measure_exact(const std::filesystem::path& file, double moment_ratio) {
  const solver::Scene scene = solver::read_scene(
      file, {fmt::format("grid.cells=[{0}, {0}]", kExactCells), fmt::format("load.moment_ratio={}", moment_ratio)});
  const solver::Grid grid = solver::make_model(scene).grid_in_m();
  const Eigen::ArrayXd radius = (solver::cell_x1(grid).square() + solver::cell_x2(grid).square()).sqrt();
  Eigen::ArrayXd traction(radius.size());
  double error = 0.0;
  const Json seconds = repeated_seconds([&] {
    const auto start = std::chrono::steady_clock::now();
    const convergence::Oracle oracle = convergence::require_oracle(scene);
    error = oracle.relative_uncertainty;
    for (Index i = 0; i < radius.size(); ++i) traction[i] = oracle.traction(radius[i]);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  });
  return {{"seconds", seconds}, {"error", error}, {"cells", kExactCells}};
}

}  // namespace

Json measure_point(const std::filesystem::path& scene, const Json& run) {
  Json json = run.at("choice");
  std::map<std::string, std::vector<double>> errors;
  double across = 0.0;
  std::string invalid_reason;
  std::optional<CheckedSolution> first;
  const auto all = grids(scene, run);
  for (const convergence::GridChoice& grid : all) {
    CheckedSolution measured = solve_and_check(solver::read_scene(scene, grid.overrides));
    for (const auto& [name, error] : values(measured.errors)) errors[name].push_back(error);
    across += 2.0 * measured.solution.contact_radius / grid.size / static_cast<double>(all.size());
    if (invalid_reason.empty()) invalid_reason = measured.invalid_reason;
    if (!first) first = std::move(measured);
  }
  json["contact_cells"] = across;
  if (!invalid_reason.empty()) json["not_timed"] = invalid_reason;
  if (invalid_reason.empty()) {
    const solver::Scene timed = solver::read_scene(scene, all.front().overrides);
    json["seconds"] = repeated_seconds([&] { return convergence::solve_with_path(timed).seconds.total; });
  } else {
    set_missing(json, "seconds", invalid_reason);
  }
  add_errors(json, errors);
  set_number(json, "gap", first->solution.certificate.gap, "the solve broke down");
  json["applications"] = first->solution.operator_applications;
  json["pressure_applications"] = first->solution.pressure_applications;
  json["bytes"] = first->solution.bytes;
  return json;
}

Json measure_load(const PlaneOptions& options, const Json& load, convergence::Progress& progress) {
  const convergence::ResultCache cache(options.output);
  Json scene{{"name", load.at("name")}, {"moment_ratio", load.at("moment_ratio")}, {"points", Json::array()}};
  for (const Json& run : load.at("runs")) {
    const std::string key =
        convergence::prepare_run({.scene = options.scene, .overrides = overrides_of(run)}).cache_key;
    std::optional<Json> point = cache.find(run.at("file"), key);
    if (!point) cache.keep(run.at("file"), key, point.emplace(measure_point(options.scene, run)));
    scene["points"].push_back(*std::move(point));
    progress.finished(run.at("label"), 1.0);
  }
  scene["exact"] = measure_exact(options.scene, load.at("moment_ratio"));
  return scene;
}

Json measure_plane(const PlaneOptions& options) {
  const Json design =
      convergence::run_package_module("speed.plane", {{"what", "design"}, {"quick", options.quick}}).result;
  Json plane{{"quick", options.quick}, {"quantities", design.at("quantities")}};
  plane["application_seconds"] = convergence::application_seconds(solver::read_scene(options.scene));
  std::size_t points = 0;
  for (const Json& load : design.at("loads")) points += load.at("runs").size();
  convergence::Progress progress;
  progress.begin_runs(points, static_cast<double>(points), points);
  for (const Json& load : design.at("loads")) plane["scenes"].push_back(measure_load(options, load, progress));
  plane["provenance"] = convergence::provenance(1);
  return plane;
}

}  // namespace slipstick::bench
