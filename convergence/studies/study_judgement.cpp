#include "convergence/studies/study_plan.hpp"

#include <fmt/core.h>
#include <gsl/gsl_statistics_double.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "convergence/orders/expected_order.hpp"
#include "convergence/orders/limit.hpp"
#include "convergence/results/quantity.hpp"
#include "convergence/runs/failed_runs.hpp"
#include "convergence/studies/budget.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

/// No order is fitted while the iteration error is a larger part of the discretisation error.
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

/// Mean and standard deviation of the grids that converged; noise is not known yet.
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

/// Rounding is measured on one mesh and taken to be the same part of the result on the others.
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
    curve.budgets.push_back(
        split_error(quantity, results[i].grids.front(), results[i].tightened, results[i].rounded));
  }
  const double rounding = rounding_of(curve.budgets, series.meshes);
  for (std::size_t i = 0; i < results.size(); ++i) {
    curve.budgets[i].rounding = rounding;
    curve.samples[i].noise = std::abs(curve.budgets[i].iteration) + rounding;
  }
  return curve;
}

/// A result that converged, of the finest mesh that has one; where none did, one that there is, if any.
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

/// The quantities of a series: those asked for, or all errors that there are; values of what the exact answer
/// does not say, or where there is none.
std::vector<std::pair<std::string, bool>> choose_quantities(const Study& study, const Json& result) {
  std::vector<std::pair<std::string, bool>> chosen;
  const auto is_error = [](const std::string& path) { return path.find("_error") != std::string::npos; };
  if (!study.quantities.empty()) {
    for (const std::string& path : study.quantities) {
      if (!is_failed(result) && find_quantity(result, path).value == nullptr) {
        throw solver::InputError(study.source.string(), "quantities", path,
                                 "paths into a result, as slipstick solve --json writes it");
      }
      chosen.emplace_back(path, is_error(path));
    }
    return chosen;
  }
  const auto choose = [&](const std::string& path, bool exact) {
    if (std::isfinite(number_at(result, path))) chosen.emplace_back(path, exact);
  };
  const auto exact = result.find("exact");
  for (const std::string& path : value_quantities()) {
    if (exact == result.end() || (exact->contains(path) && exact->at(path).is_null())) choose(path, false);
  }
  if (exact == result.end()) return chosen;
  for (const ErrorQuantity& error : error_quantities()) choose(error.path, true);
  // Beside the radius the ratio says nothing new; of some contacts it is all that is known.
  if (std::isfinite(number_at(result, "stick_radius_error"))) {
    std::erase(chosen, std::pair<std::string, bool>("stick_ratio_error", true));
  }
  return chosen;
}

/// Whether every cell of every grid sticks: then the edges of contact and stick lie between cells.
bool is_aligned(const solver::Scene& scene, const std::vector<MeshResults>& results) {
  if (scene.pressure != solver::PressureModel::solved) return false;
  return std::ranges::all_of(results, [](const MeshResults& at) {
    return std::ranges::all_of(at.grids, [](const Json& result) {
      return number_at(result, "stick_cells") ==
             number_at(result, "cells[0]") * number_at(result, "cells[1]");
    });
  });
}

/// The limit of a curve of values; the curve becomes that of its errors relative to it.
Limit find_limit(Curve& curve, const ExpectedOrder& expected, bool aligned) {
  const Limit limit = aligned && std::isfinite(expected.value)
                          ? expansion_limit(curve.samples, aligned_edge_powers(), expected.value)
                          : least_squares_limit(curve.samples, expected.value);
  const double scale = std::abs(limit.value);
  for (MeshSample& sample : curve.samples) {
    sample = {sample.size, sample.value / limit.value - 1.0, sample.spread / scale, sample.grids,
              sample.noise / scale};
  }
  for (Budget& budget : curve.budgets) {
    budget = {budget.observed / limit.value - 1.0, budget.discretisation / limit.value - 1.0,
              budget.iteration / limit.value, budget.rounding / scale, limit.uncertainty / scale};
  }
  return limit;
}

/// Whether stopping earlier than necessary shows in an error. What is at its floor, or is imposed, is not
/// looked at.
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

Json order_json(const Order& order, const ExpectedOrder& expected) {
  Json json;
  set_number(json, "value", order.value, order.why);
  set_number(json, "low", order.low, order.why);
  set_number(json, "high", order.high, order.why);
  set_number(json, "constant", order.constant, order.why);
  json["verdict"] = to_string(order.verdict);
  json["why"] = order.why;
  set_number(json, "expected", expected.value, expected.why);
  json["expected_why"] = expected.why;
  json["sizes"] = order.sizes;
  return json;
}

const std::string& first_of(const std::string& one, const std::string& other) {
  return one.empty() ? other : one;
}

/// Why a part of a mesh's budget is missing: what the first of the runs that it rests on says; empty: none
/// is.
std::string missing_part(const Series& series, const std::vector<MeshResults>& results, std::size_t mesh,
                         const std::string& quantity) {
  std::string missing = first_of(why_missing(results[mesh].grids.front(), quantity),
                                 why_missing(results[mesh].tightened, quantity));
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (!series.meshes[i].rounded) continue;
    missing = first_of(missing, why_missing(results[i].tightened, quantity));
    for (const Json& rounded : results[i].rounded)
      missing = first_of(missing, why_missing(rounded, quantity));
  }
  return missing;
}

/// One line of the budget. The trend is what the fitted order says for the mesh, the staircase what is left
/// of the discretisation: how this grid happens to lie.
Json budget_json(const Curve& curve, const Order& order, std::size_t mesh, const Mesh& grids,
                 const std::string& missing) {
  const Budget& budget = curve.budgets[mesh];
  Json json;
  json["quantity"] = curve.quantity;
  json["cells"] = grids.grids.front().cells;
  json["h"] = grids.grids.front().size;
  const std::string& none = first_of(missing, order.why);
  set_number(json, "observed", budget.observed, none);
  set_number(json, "discretisation", budget.discretisation, none);
  set_number(json, "iteration", budget.iteration, none);
  set_number(json, "rounding", budget.rounding, none);
  set_number(json, "reference", budget.reference, "the reference does not say");
  const double trend = order.constant * std::pow(grids.grids.front().size, order.value);
  const std::string unfitted = "no order was fitted";
  set_number(json, "trend", trend, unfitted);
  set_number(json, "staircase", budget.discretisation - trend, first_of(missing, unfitted));
  return json;
}

/// A quantity on a mesh: what is there of its grids.
Json mesh_json(const Curve& curve, const Order& order, std::size_t mesh, const Mesh& grids,
               const std::string& missing) {
  const MeshSample& sample = curve.samples[mesh];
  const std::string none = sample.grids == 0 ? "no grid of this mesh converged" : order.why;
  Json json;
  json["grids"] = sample.grids;
  set_number(json, "mean", sample.value, none);
  if (sample.grids == 1 && grids.grids.size() > 1) {
    set_missing(json, "spread", "one grid of this mesh converged, and has no spread");
  } else {
    set_number(json, "spread", sample.spread, none);
  }
  set_number(json, "noise", sample.noise, first_of(missing, none));
  return json;
}

/// Those that a series is judged by.
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

Json row_json(const Json& result, const GridChoice& grid, double tolerance, std::size_t shift,
              const std::vector<std::string>& quantities) {
  Json row;
  row["cells"] = grid.cells;
  row["h"] = grid.size;
  row["shift"] = shift;
  row["requested"] = tolerance;
  row["status"] = result["status"];
  if (result.contains("message")) row["message"] = result["message"];
  for (const char* path : {"certificate.gap", "certificate.friction_bound", "slip_direction.mean", "change",
                           "operator_applications", "iterations"}) {
    set_number(row, path, number_at(result, path), why_missing(result, path));
  }
  for (const std::string& path : quantities) {
    set_number(row, path, number_at(result, path), why_missing(result, path));
  }
  set_number(row, "seconds", seconds_of(result), why_missing(result, "seconds.total"));
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

}  // namespace

Json judge_series(const Study& study, const Series& series, const std::vector<MeshResults>& results) {
  const Json& sample = sample_result(results);
  const solver::Scene scene = solver::read_scene(study.scene, series.overrides);
  const auto quantities = choose_quantities(study, sample);
  std::vector<std::string> paths;
  for (const auto& [path, exact] : quantities) paths.push_back(path);
  Json json;
  json["set"] = series.set;
  json["tolerance"] = series.tolerance;
  json["tightened"] = series.tightenings;
  json["basis"] = std::ranges::any_of(quantities, [](const auto& chosen) { return chosen.second; })
                      ? "exact"
                      : "extrapolated";
  set_number(json, "reference_uncertainty", number_at(sample, "exact.relative_uncertainty"),
             is_failed(sample) ? sample.value("message", "") : "there is no exact answer");
  json["failed_runs"] = failed_runs(results).json();
  const std::string failures = failed_runs_text(json);
  json["rows"] = Json::array();
  json["meshes"] = Json::array();
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Mesh& mesh = series.meshes[i];
    for (std::size_t k = 0; k < results[i].grids.size(); ++k) {
      json["rows"].push_back(row_json(results[i].grids[k], mesh.grids[k], series.tolerance, k, paths));
    }
    Json& row = json["meshes"].emplace_back(
        Json{{"cells", mesh.grids.front().cells}, {"h", mean_size(mesh)}, {"grids", mesh.grids.size()}});
    set_number(row, "seconds", median_seconds(results[i].grids), "no grid of it was solved");
  }
  json["order"] = Json::object();
  json["extrapolated"] = Json::object();
  json["budget"] = Json::array();
  for (const auto& [path, exact] : quantities) {
    Curve curve = make_curve(series, results, path, exact);
    const ExpectedOrder expected = expected_order(path, scene);
    Order order;
    if (exact) {
      order = fit_order(curve.samples, expected.value);
    } else {
      const Limit limit = find_limit(curve, expected, is_aligned(scene, results));
      order = limit.order;
      order.constant /= limit.value;  // as the curve is now
      Json& found = json["extrapolated"][path];
      set_number(found, "value", limit.value, order.why);
      set_number(found, "uncertainty", limit.uncertainty, order.why);
      found["method"] = limit.method;
    }
    if (!failures.empty()) order.why += "; " + failures;
    json["order"][path] = order_json(order, expected);
    json["order"][path]["basis"] = exact ? "exact" : "extrapolated";
    for (std::size_t i = 0; i < results.size(); ++i) {
      const std::string missing = missing_part(series, results, i, path);
      json["meshes"][i][path] = mesh_json(curve, order, i, series.meshes[i], missing);
      json["budget"].push_back(budget_json(curve, order, i, series.meshes[i], missing));
    }
  }
  return json;
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

Json tolerance_rows(const Study& study, const Series& series, const std::vector<std::vector<Json>>& by_mesh,
                    const std::vector<MeshResults>& results) {
  const auto chosen = choose_quantities(study, sample_result(results));
  std::vector<std::string> quantities;
  for (const auto& [path, exact] : chosen) quantities.push_back(path);
  Json rows = Json::array();
  for (std::size_t i = 0; i < by_mesh.size(); ++i) {
    const std::vector<Json>& at = by_mesh[i];
    for (std::size_t k = 0; k < study.tolerances.size(); ++k) {
      Json row = row_json(at[k], series.meshes[i].grids.front(), study.tolerances[k], 0, quantities);
      for (const auto& [path, exact] : chosen) {
        const double tightest = number_at(at.back(), path);
        const double scale = exact ? 1.0 : std::abs(tightest);
        const std::string missing = first_of(why_missing(at[k], path), why_missing(at.back(), path));
        set_number(row["iteration"], path, (number_at(at[k], path) - tightest) / scale,
                   first_of(missing, "the tightest run gives zero"));
      }
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

}  // namespace slipstick::convergence
