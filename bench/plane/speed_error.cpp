#include "bench/plane/speed_error.hpp"

#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <utility>

#include "bench/timing/checked_solve.hpp"
#include "convergence/orders/growth.hpp"
#include "convergence/results/exact_result.hpp"
#include "convergence/results/provenance.hpp"
#include "convergence/runs/path_uncertainty.hpp"
#include "convergence/runs/result_cache.hpp"
#include "convergence/runs/run_spec.hpp"
#include "convergence/solve/cost.hpp"
#include "convergence/studies/study_plan.hpp"
#include "solver/model/make_model.hpp"

namespace slipstick::bench {
namespace {

using convergence::Errors;
using convergence::set_missing;
using convergence::set_number;
using solver::Index;

/// Quantities of the plane, and their names in text.
const std::vector<std::pair<std::string, std::string>> kQuantities{
    {"twist", "twist"},
    {"traction_l1", "traction, mean (L1)"},
    {"traction_l2", "traction, root mean square (L2)"},
    {"stick_radius", "stick radius"}};

/// Grids of a mesh, whose edges lie differently in the cells: four, and fewer where one takes seconds.
int grids_of(Index cells) { return cells <= 256 ? 4 : cells <= 512 ? 3 : 2; }

/// Cells along a side of the grid on which the exact side gives tractions.
constexpr Index kExactCells = 128;

std::vector<double> values(const Errors& errors) {
  return {errors.twist, errors.traction.at_centres.l1, errors.traction.at_centres.l2, errors.stick_radius};
}

/// Work that returns its own seconds is repeated at least kMinRepetitions times, then until kMaxRepetitions
/// or until kEnoughSeconds have passed.
constexpr std::size_t kMinRepetitions = 3;
constexpr std::size_t kMaxRepetitions = 9;
constexpr double kEnoughSeconds = 1.0;

/// The median of repeated times with its 95 % interval.
Json repeated_seconds(const std::function<double()>& work) {
  std::vector<double> seconds;
  double total = 0.0;
  while (seconds.size() < kMinRepetitions || (seconds.size() < kMaxRepetitions && total < kEnoughSeconds)) {
    seconds.push_back(work());
    total += seconds.back();
  }
  const convergence::TypicalSeconds time = convergence::typical(seconds);
  return {{"median", time.seconds}, {"low", time.low}, {"high", time.high}, {"repetitions", seconds.size()}};
}

Json choice_json(const PlaneChoice& choice) {
  Json json;
  for (const ChoiceKey& key : kChoiceKeys) json[key.name] = choice.*key.word;
  json["cells"] = choice.cells;
  json["tolerance"] = choice.tolerance;
  return json;
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// errors: of each quantity, of each grid.
void add_errors(Json& json, const std::vector<std::vector<double>>& errors) {
  for (std::size_t i = 0; i < kQuantities.size(); ++i) {
    const std::string& name = kQuantities[i].first;
    set_number(json["error"], name, root_mean_square(errors[i]), "a grid's error is not a number");
    for (const double error : errors[i]) {
      json["errors"][name].push_back(std::isfinite(error) ? Json(error) : Json(nullptr));
    }
  }
}

std::vector<std::string> all_overrides(double moment_ratio, const PlaneChoice& choice) {
  std::vector<std::string> all = overrides(choice);
  all.push_back(fmt::format("load.moment_ratio={}", moment_ratio));
  return all;
}

std::vector<convergence::GridChoice> grids(const std::filesystem::path& scene, double moment_ratio,
                                           const PlaneChoice& choice) {
  convergence::Study study;
  study.source = study.scene = scene;
  study.overrides = all_overrides(moment_ratio, choice);
  study.cells = {choice.cells};
  study.shifts = grids_of(choice.cells);
  return convergence::make_series(study).front().meshes.front().grids;
}

/// The name of the point's file.
std::string file_name(double moment_ratio, const PlaneChoice& choice) {
  return fmt::format("plane-{}-{}-{}-{}", moment_ratio, choice_words(choice, "-"), choice.cells,
                     choice.tolerance);
}

/// The whole exact answer: stick radius and twist from the load, then tractions in the cells of a grid.
Json measure_exact(const std::filesystem::path& file, double moment_ratio) {
  const solver::Scene scene = solver::read_scene(file, all_overrides(moment_ratio, {.cells = kExactCells}));
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

std::string label(double moment_ratio, const PlaneChoice& choice) {
  return fmt::format("M/M_lim {}: {}, {} cells, tolerance {}", moment_ratio, choice_words(choice, " "),
                     choice.cells, choice.tolerance);
}

}  // namespace

Json measure_point(const std::filesystem::path& scene, double moment_ratio, const PlaneChoice& choice) {
  Json json = choice_json(choice);
  std::vector<std::vector<double>> errors(kQuantities.size());
  double across = 0.0;
  std::string invalid_reason;
  std::optional<CheckedSolution> first;
  const auto all = grids(scene, moment_ratio, choice);
  for (const convergence::GridChoice& grid : all) {
    CheckedSolution measured = solve_and_check(solver::read_scene(scene, grid.overrides));
    const std::vector<double> of_grid = values(measured.errors);
    for (std::size_t i = 0; i < errors.size(); ++i) errors[i].push_back(of_grid[i]);
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

Json measure_scene(const PlaneOptions& options, double moment_ratio, const std::vector<PlaneChoice>& design,
                   convergence::Progress& progress) {
  const convergence::ResultCache cache(options.output);
  Json scene{{"name", fmt::format("paper-{}", moment_ratio)},
             {"moment_ratio", moment_ratio},
             {"points", Json::array()}};
  for (const PlaneChoice& choice : design) {
    const std::string key =
        convergence::prepare_run({.scene = options.scene, .overrides = all_overrides(moment_ratio, choice)})
            .cache_key;
    const std::string name = file_name(moment_ratio, choice);
    std::optional<Json> point = cache.find(name, key);
    if (!point) cache.keep(name, key, point.emplace(measure_point(options.scene, moment_ratio, choice)));
    scene["points"].push_back(*std::move(point));
    progress.finished(label(moment_ratio, choice), 1.0);
  }
  scene["exact"] = measure_exact(options.scene, moment_ratio);
  return scene;
}

Json measure_plane(const PlaneOptions& options) {
  Json plane;
  plane["quick"] = options.quick;
  for (const auto& [name, text] : kQuantities)
    plane["quantities"].push_back({{"name", name}, {"label", text}});
  plane["application_seconds"] = convergence::application_seconds(solver::read_scene(options.scene));
  const std::vector<double> ratios = plane_moment_ratios(options.quick);
  std::size_t points = 0;
  for (const double ratio : ratios) points += plane_design(ratio, options.quick).size();
  convergence::Progress progress(points, static_cast<double>(points));
  for (const double ratio : ratios) {
    plane["scenes"].push_back(measure_scene(options, ratio, plane_design(ratio, options.quick), progress));
  }
  judge_plane(plane);
  plane["provenance"] = convergence::provenance(1);
  return plane;
}

}  // namespace slipstick::bench
