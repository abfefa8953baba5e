#include "convergence/studies/study_judgement.hpp"

#include <fmt/core.h>
#include <gsl/gsl_statistics_double.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "convergence/orders/expected_order.hpp"
#include "convergence/orders/limit.hpp"
#include "convergence/runs/run_spec.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

/// The tolerance is reduced while the iteration error is a larger part of the discretisation error.
constexpr double kIterationPart = 0.1;

/// A quantity through the meshes of a series.
struct Curve {
  std::string quantity;
  bool exact;  ///< an error against an exact answer, not a value
  std::vector<MeshSample> samples;
  std::vector<Budget> budgets;  ///< of each mesh's first grid; of a value relative to it
};

double mean_size(const Mesh& mesh) {
  double sum = 0.0;
  for (const GridChoice& grid : mesh.grids) sum += grid.size;
  return sum / static_cast<double>(mesh.grids.size());
}

/// Mean and standard deviation of the grids that converged; the noise is set later.
MeshSample sample_of(const Mesh& mesh, const std::vector<Json>& results, const std::string& quantity) {
  MeshSample sample{0.0, 0.0, 0.0, 0, NAN};
  double squares = 0.0;
  for (std::size_t k = 0; k < results.size(); ++k) {
    const double value = is_converged(results[k]) ? number_at(results[k], quantity) : NAN;
    if (!std::isfinite(value)) continue;
    ++sample.grids;
    const double from_mean = value - sample.value;
    sample.value += from_mean / sample.grids;
    squares += from_mean * (value - sample.value);
    sample.size += (mesh.grids[k].size - sample.size) / sample.grids;
  }
  if (sample.grids == 0) return {mesh.grids.front().size, NAN, NAN, 0, NAN};
  if (sample.grids > 1) sample.spread = std::sqrt(squares / (sample.grids - 1));
  return sample;
}

/// Rounding is measured on one mesh and taken to have the same size on the others.
double rounding_of(const std::vector<Budget>& budgets, const std::vector<Mesh>& meshes) {
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    if (meshes[i].rounded) return budgets[i].rounding;
  }
  return NAN;
}

Curve make_curve(const Series& series, const std::vector<MeshResults>& results, const std::string& quantity,
                 bool exact) {
  Curve curve{quantity, exact, {}, {}};
  for (std::size_t i = 0; i < results.size(); ++i) {
    curve.samples.push_back(sample_of(series.meshes[i], results[i].grids, quantity));
    curve.budgets.push_back(split_error(quantity, results[i].grids.front(), results[i].tightened, results[i].rounded));
  }
  const double rounding = rounding_of(curve.budgets, series.meshes);
  for (std::size_t i = 0; i < results.size(); ++i) {
    curve.budgets[i].rounding = rounding;
    curve.samples[i].noise = std::abs(curve.budgets[i].iteration) + rounding;
  }
  return curve;
}

/// A converged result of the finest mesh that has one; else any result; else a failure.
const Json& sample_result(const std::vector<MeshResults>& results) {
  const Json* sample = &results.front().grids.front();
  for (auto at = results.rbegin(); at != results.rend(); ++at) {
    for (const Json& grid : at->grids) {
      if (is_converged(grid)) return grid;
      if (is_failed(*sample)) sample = &grid;
    }
  }
  return *sample;
}

/// A quantity of a series. exact: an error against an exact answer, not a value.
struct Chosen {
  std::string path;
  bool exact;
};

/// The quantities of the study file.
std::vector<Chosen> named_quantities(const Study& study, const Json& result) {
  std::vector<Chosen> chosen;
  for (const std::string& path : study.quantities) {
    if (!is_failed(result) && find_quantity(result, path).value == nullptr) {
      throw solver::InputError(study.source.string(), "quantities", path,
                               "paths into a result, as slipstick solve --json writes it");
    }
    chosen.push_back({path, path.find("_error") != std::string::npos});
  }
  return chosen;
}

/// The quantities of the study file; without them all errors of the result, and the values for which there is
/// no exact answer.
std::vector<Chosen> choose_quantities(const Study& study, const Json& result) {
  if (!study.quantities.empty()) return named_quantities(study, result);
  std::vector<Chosen> chosen;
  const auto choose = [&](const std::string& path, bool exact) {
    if (std::isfinite(number_at(result, path))) chosen.push_back({path, exact});
  };
  const auto exact = result.find("exact");
  for (const std::string& path : value_quantities()) {
    if (exact == result.end() || (exact->contains(path) && exact->at(path).is_null())) choose(path, false);
  }
  if (exact == result.end()) return chosen;
  for (const ErrorQuantity& error : error_quantities()) choose(error.path, true);
  // The stick ratio follows from the radius, unless only the ratio has an exact answer.
  if (std::isfinite(number_at(result, "stick_radius_error")))
    std::erase_if(chosen, [](const Chosen& each) { return each.path == "stick_ratio_error"; });
  return chosen;
}

/// Whether every cell of every grid sticks: then the edges of contact and stick lie between cells.
bool is_aligned(const solver::Scene& scene, const std::vector<MeshResults>& results) {
  if (scene.contact.pressure != solver::PressureModel::solved) return false;
  return std::ranges::all_of(results, [](const MeshResults& at) {
    return std::ranges::all_of(at.grids, [](const Json& result) {
      return number_at(result, "stick_cells") == number_at(result, "cells[0]") * number_at(result, "cells[1]");
    });
  });
}

/// The limit of a curve of values. The curve becomes value / limit - 1.
Limit find_limit(Curve& curve, const ExpectedOrder& expected, bool aligned) {
  const Limit limit = aligned && std::isfinite(expected.value)
                          ? expansion_limit(curve.samples, aligned_edge_powers(), expected.value)
                          : least_squares_limit(curve.samples, expected.value);
  const double scale = std::abs(limit.value);
  for (MeshSample& sample : curve.samples) {
    sample = {sample.size, sample.value / limit.value - 1.0, sample.spread / scale, sample.grids, sample.noise / scale};
  }
  for (Budget& budget : curve.budgets) {
    budget = {budget.observed / limit.value - 1.0, budget.discretisation / limit.value - 1.0,
              budget.iteration / limit.value, budget.rounding / scale, limit.uncertainty / scale};
  }
  return limit;
}

/// Whether the iteration error shows in an error that is above rounding and reference.
bool iteration_shows(const Curve& curve, const Series& series) {
  for (std::size_t i = 0; i < curve.budgets.size(); ++i) {
    const Budget& budget = curve.budgets[i];
    const double part = std::abs(budget.iteration) / std::abs(budget.discretisation);
    if (part > kIterationPart && std::abs(budget.iteration) > budget.rounding + budget.reference &&
        series.meshes[i].grids.front().size > 0.0) {
      return true;
    }
  }
  return false;
}

const std::string& first_of(const std::string& one, const std::string& other) { return one.empty() ? other : one; }

/// Why a part of a mesh's budget is missing: the reason of the first run without a result; empty: nothing is missing.
std::string missing_part(const Series& series, const std::vector<MeshResults>& results, std::size_t mesh,
                         const std::string& quantity) {
  std::string missing =
      first_of(why_missing(results[mesh].grids.front(), quantity), why_missing(results[mesh].tightened, quantity));
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (!series.meshes[i].rounded) continue;
    missing = first_of(missing, why_missing(results[i].tightened, quantity));
    for (const Json& rounded : results[i].rounded) missing = first_of(missing, why_missing(rounded, quantity));
  }
  return missing;
}

BudgetLine budget_line(const Curve& curve, const Order& order, std::size_t mesh, double h, const std::string& missing) {
  const Budget& budget = curve.budgets[mesh];
  const std::string& none = first_of(missing, order.why);
  const std::string unfitted = "no order was fitted";
  const double trend = order.constant * std::pow(h, order.value);
  return {.h = h,
          .observed = number_or(budget.observed, none),
          .discretisation = number_or(budget.discretisation, none),
          .iteration = number_or(budget.iteration, none),
          .rounding = number_or(budget.rounding, none),
          .reference = number_or(budget.reference, "the reference does not say"),
          .trend = number_or(trend, unfitted),
          .staircase = number_or(budget.discretisation - trend, first_of(missing, unfitted))};
}

MeshQuantity mesh_quantity(const MeshSample& sample, const Order& order, std::size_t grids,
                           const std::string& missing) {
  const std::string none = sample.grids == 0 ? "no grid of this mesh converged" : order.why;
  const bool one_left = sample.grids == 1 && grids > 1;
  return {.grids = sample.grids,
          .mean = number_or(sample.value, none),
          .spread = one_left ? Number{.why_missing = "one grid of this mesh converged, and has no spread"}
                             : number_or(sample.spread, none),
          .noise = number_or(sample.noise, first_of(missing, none))};
}

/// The runs by which a series is judged.
FailedRuns failed_runs(const std::vector<MeshResults>& results) {
  FailedRuns failed;
  int runs = 0;
  const auto add = [&](const Json& result) { failed.add(fmt::format("run {}", ++runs), result); };
  for (const MeshResults& at : results) {
    for (const Json& result : at.grids) add(result);
    add(at.tightened);
    for (const Json& result : at.rounded) add(result);
  }
  return failed;
}

Number number_of(const Json& result, const std::string& path) {
  return number_or(number_at(result, path), why_missing(result, path));
}

StudyRow make_row(const Json& result, const GridChoice& grid, double tolerance, std::size_t shift,
                  const std::vector<Chosen>& quantities) {
  StudyRow row{.cells = grid.cells, .h = grid.size, .shift = shift, .requested = tolerance};
  row.status = result.value("status", "");
  if (const auto message = result.find("message"); message != result.end()) row.message = *message;
  for (const char* path : {"certificate.gap", "certificate.friction_bound", "slip_direction.mean", "change",
                           "operator_applications", "iterations"}) {
    row.numbers.emplace_back(path, number_of(result, path));
  }
  for (const auto& [path, exact] : quantities) row.numbers.emplace_back(path, number_of(result, path));
  row.seconds = number_or(seconds_of(result), why_missing(result, "seconds.total"));
  return row;
}

/// The median over a mesh's grids, each solved once.
double median_seconds(const std::vector<Json>& grids) {
  std::vector<double> seconds;
  for (const Json& result : grids) {
    if (const double one = seconds_of(result); std::isfinite(one)) seconds.push_back(one);
  }
  return seconds.empty() ? kNaN : gsl_stats_median(seconds.data(), 1, seconds.size());
}

QuantityResult judge_quantity(const Chosen& chosen, const solver::Scene& scene, const Series& series,
                              const std::vector<MeshResults>& results, const std::string& failures) {
  QuantityResult judged{.path = chosen.path, .exact = chosen.exact};
  Curve curve = make_curve(series, results, chosen.path, chosen.exact);
  judged.expected = expected_order(chosen.path, scene);
  if (chosen.exact) {
    judged.order = fit_order(curve.samples, judged.expected.value);
  } else {
    const Limit limit = find_limit(curve, judged.expected, is_aligned(scene, results));
    judged.order = limit.order;
    judged.order.constant /= limit.value;  // of the curve, which find_limit() has made relative
    judged.extrapolated = {number_or(limit.value, limit.order.why), number_or(limit.uncertainty, limit.order.why),
                           limit.method};
  }
  if (!failures.empty()) judged.order.why += "; " + failures;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const std::vector<GridChoice>& grids = series.meshes[i].grids;
    const std::string missing = missing_part(series, results, i, chosen.path);
    judged.meshes.push_back(mesh_quantity(curve.samples[i], judged.order, grids.size(), missing));
    judged.budget.push_back(budget_line(curve, judged.order, i, grids.front().size, missing));
  }
  return judged;
}

}  // namespace

std::vector<RunSpec> budget_runs(const RunSpec& observed, double tolerance) {
  std::vector<RunSpec> runs(3, changed(observed, {fmt::format("solver.tolerance={}", kTightening * tolerance)}));
  runs[1].rounding = Rounding::upward;
  runs[2].rounding = Rounding::downward;
  return runs;
}

Budget split_error(const std::string& quantity, const Json& observed, const Json& tightened,
                   const std::vector<Json>& rounded) {
  Budget budget;
  budget.observed = number_at(observed, quantity);
  budget.discretisation = number_at(tightened, quantity);
  budget.iteration = budget.observed - budget.discretisation;
  budget.rounding = rounded.empty() ? NAN : 0.0;
  for (const Json& result : rounded) {
    const double change = std::abs(number_at(result, quantity) - budget.discretisation);
    const bool keep = std::isnan(budget.rounding) || change <= budget.rounding;
    budget.rounding = keep ? budget.rounding : change;
  }
  budget.reference = number_at(observed, "exact.relative_uncertainty");
  return budget;
}

Budget error_budget(const PreparedRun& run, const std::string& quantity, const ProcessPool& pool) {
  std::vector<RunSpec> runs = budget_runs(run.spec, run.scene.solver.tolerance);
  runs.insert(runs.begin(), run.spec);
  const std::vector<Json> results = to_json(pool.run(runs));
  return split_error(quantity, results[0], results[1], {results[2], results[3]});
}

std::string largest_part(const Budget& budget) {
  const std::pair<double, const char*> parts[] = {{std::abs(budget.discretisation), "discretisation"},
                                                  {std::abs(budget.iteration), "iteration"},
                                                  {budget.rounding, "rounding"},
                                                  {budget.reference, "reference"}};
  return std::max_element(std::begin(parts), std::end(parts),
                          [](const auto& a, const auto& b) { return a.first < b.first || std::isnan(a.first); })
      ->second;
}

SeriesResult judge_series(const Study& study, const Series& series, const std::vector<MeshResults>& results) {
  const Json& sample = sample_result(results);
  const solver::Scene scene = solver::read_scene(study.scene, series.overrides);
  const std::vector<Chosen> quantities = choose_quantities(study, sample);
  SeriesResult judged{
      .name = series.name,
      .set = series.set,
      .tolerance = series.tolerance,
      .tightened = series.tightenings,
      .reference_uncertainty = number_or(number_at(sample, "exact.relative_uncertainty"),
                                         is_failed(sample) ? sample.value("message", "") : "there is no exact answer"),
      .failed_runs = failed_runs(results)};
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Mesh& mesh = series.meshes[i];
    for (std::size_t k = 0; k < results[i].grids.size(); ++k)
      judged.rows.push_back(make_row(results[i].grids[k], mesh.grids[k], series.tolerance, k, quantities));
    judged.meshes.push_back({.cells = mesh.grids.front().cells,
                             .h = mean_size(mesh),
                             .grids = mesh.grids.size(),
                             .seconds = number_or(median_seconds(results[i].grids), "no grid of it was solved")});
  }
  const std::string failures = judged.failed_runs.text();
  for (const Chosen& chosen : quantities)
    judged.quantities.push_back(judge_quantity(chosen, scene, series, results, failures));
  return judged;
}

bool needs_tightening(const Study& study, const Series& series, const std::vector<MeshResults>& results) {
  const solver::Scene scene = solver::read_scene(study.scene, series.overrides);
  for (const auto& [path, exact] : choose_quantities(study, sample_result(results))) {
    Curve curve = make_curve(series, results, path, exact);
    const ExpectedOrder expected = expected_order(path, scene);
    if (!std::isfinite(expected.value)) continue;
    if (!exact) find_limit(curve, expected, is_aligned(scene, results));
    if (iteration_shows(curve, series)) return true;
  }
  return false;
}

std::vector<StudyRow> tolerance_rows(const Study& study, const Series& series,
                                     const std::vector<std::vector<Json>>& by_mesh,
                                     const std::vector<MeshResults>& results) {
  const std::vector<Chosen> quantities = choose_quantities(study, sample_result(results));
  std::vector<StudyRow> rows;
  for (std::size_t i = 0; i < by_mesh.size(); ++i) {
    const Json& tightest_run = by_mesh[i].back();
    for (std::size_t k = 0; k < study.tolerances.size(); ++k) {
      const Json& result = by_mesh[i][k];
      StudyRow& row =
          rows.emplace_back(make_row(result, series.meshes[i].grids.front(), study.tolerances[k], 0, quantities));
      for (const auto& [path, exact] : quantities) {
        const double tightest = number_at(tightest_run, path);
        const double scale = exact ? 1.0 : std::abs(tightest);
        const std::string missing = first_of(why_missing(result, path), why_missing(tightest_run, path));
        row.iteration.emplace_back(path, number_or((number_at(result, path) - tightest) / scale,
                                                   first_of(missing, "the tightest run gives zero")));
      }
    }
  }
  return rows;
}

}  // namespace slipstick::convergence
