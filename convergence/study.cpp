#include "convergence/study.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "convergence/budget.hpp"
#include "convergence/expected_order.hpp"
#include "convergence/limit.hpp"
#include "convergence/provenance.hpp"
#include "convergence/quantity.hpp"
#include "solver/input_error.hpp"

namespace slipstick::convergence {
namespace {

using solver::Index;

/// No order is fitted while the iteration error is a larger part of the discretisation error.
constexpr double kIterationPart = 0.1;
/// Times that a study tightens a tolerance by itself, from 1e-8 to 1e-12.
constexpr int kMostTightenings = 2;
/// Rounding is looked at on the finest mesh up to this, where it costs little.
constexpr Index kRoundingCells = 128;
/// Of several grids of one mesh the contact's edge comes to lie over two cells' width: the grids grow by so
/// many cells in all.
constexpr double kShiftCells = 2.0;
/// A part of the budget that is this many spreads off is not explained by how the grid lies.
constexpr double kSpreads = 2.0;

/// One grid of a mesh.
struct GridChoice {
  std::vector<std::string> overrides;
  std::array<Index, 2> cells;
  double size;  ///< m, the side of a square of a cell's area
};

struct Mesh {
  std::vector<GridChoice> grids;
  bool rounded = false;  ///< rounding is looked at here
};

/// One combination of the varied values.
struct Series {
  std::string name;
  Json set = Json::object();
  std::vector<std::string> overrides;
  std::vector<Mesh> meshes;
  double tolerance = 0.0;
  int tightenings = 0;
};

/// What was computed on one mesh, to the series' tolerance.
struct MeshResults {
  std::vector<Json> grids;
  Json tightened;             ///< the first grid's
  std::vector<Json> rounded;  ///< likewise
};

bool is_converged(const Json& result) { return result.value("status", "") == "converged"; }

/// The grids of a mesh with so many cells along its longer side, in the shape of the scene's own.
Mesh make_mesh(const Study& study, const std::vector<std::string>& overrides, std::optional<Index> across) {
  std::vector<std::string> own = overrides;
  if (across) {
    const solver::Scene scene = solver::read_scene(study.scene, overrides);
    if (solver::find_height_map(scene.surfaces) != nullptr) {
      throw solver::InputError(study.source.string(), "cells", std::to_string(*across),
                               "left out: the grid is that of the scene's height map");
    }
    own.push_back(cells_override(scene, *across));
  }
  const solver::Scene scene = solver::read_scene(study.scene, own);
  const solver::Model model = solver::make_model(scene);
  const auto& [n1, n2, h1, h2, quadrant] = model.grid;
  Mesh mesh;
  for (int k = 0; k < study.shifts; ++k) {
    const double longer = static_cast<double>(std::max(n1, n2));
    const double growth = 1.0 + kShiftCells * k / (study.shifts * longer);
    const double unit = growth * model.length_unit;
    GridChoice grid{own, {n1, n2}, unit * std::sqrt(h1 * h2)};
    if (k > 0) {
      grid.overrides.push_back(fmt::format("grid.extent=[{}, {}]", unit * h1 * static_cast<double>(n1),
                                           unit * h2 * static_cast<double>(n2)));
    }
    mesh.grids.push_back(std::move(grid));
  }
  return mesh;
}

std::string without_quotes(std::string word) {
  std::erase_if(word, [](char c) { return c == '"' || c == '\''; });
  return word;
}

/// All combinations of the varied values.
std::vector<Series> make_series(const Study& study) {
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
    const solver::Scene scene = solver::read_scene(study.scene, series.overrides);
    if (series.name.empty()) series.name = scene.name;
    series.tolerance = study.tolerances.empty() ? scene.tolerance : study.tolerances.back();
    for (const Index across : study.cells)
      series.meshes.push_back(make_mesh(study, series.overrides, across));
    if (study.cells.empty()) series.meshes.push_back(make_mesh(study, series.overrides, std::nullopt));
    Mesh* sample = &series.meshes.front();
    for (Mesh& mesh : series.meshes) {
      if (std::max(mesh.grids[0].cells[0], mesh.grids[0].cells[1]) <= kRoundingCells) sample = &mesh;
    }
    sample->rounded = true;
  }
  return all;
}

Point make_point(const Study& study, const GridChoice& grid, double tolerance) {
  Point point{study.scene, grid.overrides};
  point.overrides.push_back(fmt::format("solver.tolerance={}", tolerance));
  return point;
}

/// Collects points, then hands out their results in the same order.
class Batch {
 public:
  explicit Batch(PointRunner& runner) : runner_(runner) {}
  void add(Point point) { points_.push_back(std::move(point)); }
  void run() { results_ = runner_.run(points_); }
  Json next() { return std::move(results_[taken_++]); }

 private:
  PointRunner& runner_;
  std::vector<Point> points_;
  std::vector<Json> results_;
  std::size_t taken_ = 0;
};

void add_points(const Study& study, const Series& series, Batch& batch) {
  for (const Mesh& mesh : series.meshes) {
    for (const GridChoice& grid : mesh.grids) batch.add(make_point(study, grid, series.tolerance));
    const BudgetPoints parts = budget_points(make_point(study, mesh.grids.front(), series.tolerance));
    batch.add(parts.tightened);
    if (!mesh.rounded) continue;
    for (const Point& rounded : parts.rounded) batch.add(rounded);
  }
}

std::vector<MeshResults> take_results(const Series& series, Batch& batch) {
  std::vector<MeshResults> results;
  for (const Mesh& mesh : series.meshes) {
    MeshResults& at = results.emplace_back();
    for (std::size_t k = 0; k < mesh.grids.size(); ++k) at.grids.push_back(batch.next());
    at.tightened = batch.next();
    if (!mesh.rounded) continue;
    at.rounded = {batch.next(), batch.next()};
  }
  return results;
}

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

/// Mean and standard deviation of the grids that converged.
MeshSample sample_of(const Mesh& mesh, const std::vector<Json>& results, const std::string& quantity) {
  MeshSample sample{0.0, 0.0, 0.0, 0, 0.0};
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
  if (sample.grids == 0) return {mesh.grids.front().size, NAN, 0.0, 1, 0.0};
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
    const double noise = std::abs(curve.budgets[i].iteration) + rounding;
    curve.samples[i].noise = std::isfinite(noise) ? noise : 0.0;
  }
  return curve;
}

/// The first result that converged, of the finest mesh if any; where none did, the first.
const Json& sample_result(const std::vector<MeshResults>& results) {
  for (auto at = results.rbegin(); at != results.rend(); ++at) {
    if (is_converged(at->grids.front())) return at->grids.front();
  }
  return results.front().grids.front();
}

/// The quantities of a series: those asked for, or all errors that there are; values of what the exact answer
/// does not say, or where there is none.
std::vector<std::pair<std::string, bool>> choose_quantities(const Study& study, const Json& result) {
  std::vector<std::pair<std::string, bool>> chosen;
  const auto is_error = [](const std::string& path) { return path.find("_error") != std::string::npos; };
  if (!study.quantities.empty()) {
    for (const std::string& path : study.quantities) {
      if (find_quantity(result, path).value == nullptr) {
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
  for (const std::string& path : error_quantities()) choose(path, true);
  // Beside the radius the ratio says nothing new; of some contacts it is all that is known.
  if (std::isfinite(number_at(result, "stick_radius_error"))) {
    std::erase(chosen, std::pair<std::string, bool>("stick_ratio_error", true));
  }
  return chosen;
}

/// Of a curve of values: where it leads, and the curve of its errors relative to that.
Limit find_limit(Curve& curve, const ExpectedOrder& expected) {
  const Limit limit = least_squares_limit(curve.samples, expected.value);
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

/// One line of the budget. The trend is what the fitted order says for the mesh, the staircase what is left
/// of the discretisation: how this grid happens to lie.
Json budget_json(const Curve& curve, const Order& order, std::size_t mesh, const Mesh& grids) {
  const Budget& budget = curve.budgets[mesh];
  const std::string unsolved = "the solve did not converge";
  Json json;
  json["quantity"] = curve.quantity;
  json["cells"] = grids.grids.front().cells;
  json["h"] = grids.grids.front().size;
  set_number(json, "observed", budget.observed, unsolved);
  set_number(json, "discretisation", budget.discretisation, unsolved);
  set_number(json, "iteration", budget.iteration, unsolved);
  set_number(json, "rounding", budget.rounding, unsolved);
  set_number(json, "reference", budget.reference, "the reference does not say");
  const double trend = order.constant * std::pow(grids.grids.front().size, order.value);
  const double staircase = budget.discretisation - trend;
  set_number(json, "trend", trend, "no order was fitted");
  set_number(json, "staircase", staircase, "no order was fitted");
  const MeshSample& sample = curve.samples[mesh];
  if (sample.grids > 1 && std::isfinite(staircase)) {
    json["adds_up"] = std::abs(staircase) <= kSpreads * sample.spread + budget.rounding + budget.reference;
  } else {
    set_missing(json, "adds_up", "one grid has no spread, or no order was fitted");
  }
  return json;
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
  const std::string unsolved = result.value("message", "the result does not have it");
  for (const char* path : {"certificate.gap", "certificate.friction_bound", "slip_direction.mean", "change",
                           "operator_applications", "iterations"}) {
    set_number(row, path, number_at(result, path), unsolved);
  }
  for (const std::string& path : quantities) {
    const FoundQuantity found = find_quantity(result, path);
    set_number(row, path, number_at(result, path), found.reason.empty() ? unsolved : found.reason);
  }
  set_number(row, "seconds", number_at(result, "seconds.total"), unsolved);
  return row;
}

/// The tolerances asked for, each on every mesh, and what stopping there added.
Json tolerance_rows(const Study& study, const Series& series, Batch& batch,
                    const std::vector<std::string>& quantities) {
  Json rows = Json::array();
  for (const Mesh& mesh : series.meshes) {
    std::vector<Json> results;
    for (std::size_t k = 0; k <= study.tolerances.size(); ++k) results.push_back(batch.next());
    for (std::size_t k = 0; k < study.tolerances.size(); ++k) {
      Json row = row_json(results[k], mesh.grids.front(), study.tolerances[k], 0, quantities);
      for (const std::string& path : quantities) {
        set_number(row["iteration"], path, number_at(results[k], path) - number_at(results.back(), path),
                   "one of the solves did not converge");
      }
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

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
             "there is no exact answer");
  json["rows"] = Json::array();
  json["meshes"] = Json::array();
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Mesh& mesh = series.meshes[i];
    for (std::size_t k = 0; k < results[i].grids.size(); ++k) {
      json["rows"].push_back(row_json(results[i].grids[k], mesh.grids[k], series.tolerance, k, paths));
    }
    json["meshes"].push_back(
        {{"cells", mesh.grids.front().cells}, {"h", mean_size(mesh)}, {"grids", mesh.grids.size()}});
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
      const Limit limit = find_limit(curve, expected);
      order = limit.order;
      order.constant /= limit.value;  // as the curve is now
      Json& found = json["extrapolated"][path];
      set_number(found, "value", limit.value, order.why);
      set_number(found, "uncertainty", limit.uncertainty, order.why);
      found["method"] = limit.method;
    }
    json["order"][path] = order_json(order, expected);
    json["order"][path]["basis"] = exact ? "exact" : "extrapolated";
    for (std::size_t i = 0; i < results.size(); ++i) {
      const MeshSample& at = curve.samples[i];
      Json& mesh = json["meshes"][i][path];
      set_number(mesh, "mean", at.value, "no grid of this mesh converged");
      mesh["spread"] = at.spread;
      mesh["noise"] = at.noise;
      json["budget"].push_back(budget_json(curve, order, i, series.meshes[i]));
    }
  }
  return json;
}

/// Whether an order that is fitted would say more about the tolerance than about the mesh.
bool needs_tightening(const Study& study, const Series& series, const std::vector<MeshResults>& results) {
  const solver::Scene scene = solver::read_scene(study.scene, series.overrides);
  for (const auto& [path, exact] : choose_quantities(study, sample_result(results))) {
    Curve curve = make_curve(series, results, path, exact);
    const ExpectedOrder expected = expected_order(path, scene);
    if (!std::isfinite(expected.value)) continue;
    if (!exact) find_limit(curve, expected);
    if (iteration_shows(curve, series)) return true;
  }
  return false;
}

/// Solves the series, again and to tighter tolerances where the iteration shows.
std::vector<std::vector<MeshResults>> solve_series(const Study& study, std::vector<Series>& all,
                                                   PointRunner& runner) {
  std::vector<std::vector<MeshResults>> results(all.size());
  std::vector<bool> open(all.size(), true);
  for (int pass = 0; pass <= kMostTightenings; ++pass) {
    Batch batch(runner);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (open[i]) add_points(study, all[i], batch);
    }
    batch.run();
    bool any = false;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!open[i]) continue;
      results[i] = take_results(all[i], batch);
      open[i] =
          pass < kMostTightenings && all[i].meshes.size() > 1 && needs_tightening(study, all[i], results[i]);
      if (!open[i]) continue;
      any = true;
      all[i].tolerance *= kTightening;
      ++all[i].tightenings;
    }
    if (!any) break;
  }
  return results;
}

/// The tolerances that the study varies, and one tighter than all that stands for none.
void add_tolerance_points(const Study& study, const Series& series, Batch& batch) {
  for (const Mesh& mesh : series.meshes) {
    for (const double tolerance : study.tolerances)
      batch.add(make_point(study, mesh.grids.front(), tolerance));
    batch.add(make_point(study, mesh.grids.front(), kTightening * study.tolerances.back()));
  }
}

}  // namespace

Json run_study(const Study& study, PointRunner& runner) {
  std::vector<Series> all = make_series(study);
  const auto results = solve_series(study, all, runner);
  Json json;
  json["name"] = study.name;
  json["scene"] = study.scene.string();
  json["shifts"] = study.shifts;
  json["series"] = Json::object();
  for (std::size_t i = 0; i < all.size(); ++i) {
    json["series"][all[i].name] = judge_series(study, all[i], results[i]);
  }
  if (study.tolerances.size() > 1) {
    Batch batch(runner);
    for (const Series& series : all) add_tolerance_points(study, series, batch);
    batch.run();
    for (std::size_t i = 0; i < all.size(); ++i) {
      std::vector<std::string> paths;
      for (const auto& [path, exact] : choose_quantities(study, sample_result(results[i]))) {
        paths.push_back(path);
      }
      json["series"][all[i].name]["tolerances"] = tolerance_rows(study, all[i], batch, paths);
    }
  }
  json["provenance"] = provenance(1);
  return json;
}

}  // namespace slipstick::convergence
