#include "convergence/studies/study_result.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "convergence/results/result_parts.hpp"

namespace slipstick::convergence {

void to_json(Json& json, const StudyRow& row) {
  json = {
      {"cells", row.cells}, {"h", row.h}, {"shift", row.shift}, {"requested", row.requested}, {"status", row.status}};
  if (row.message) json.emplace("message", *row.message);
  for (const auto& [path, number] : row.numbers) set_number(json, path, number);
  set_number(json, "seconds", row.seconds);
  Json iteration;
  for (const auto& [path, number] : row.iteration) set_number(iteration, path, number);
  if (!iteration.is_null()) json.emplace("iteration", std::move(iteration));
}

namespace {

Json to_json(const MeshQuantity& at) {
  Json json{{"grids", at.grids}};
  set_numbers(json, {{"mean", at.mean}, {"spread", at.spread}, {"noise", at.noise}});
  return json;
}

/// With the quantity on each mesh under its path.
Json to_json(const MeshRow& mesh, const std::vector<QuantityResult>& quantities, std::size_t at) {
  Json json{{"cells", mesh.cells}, {"h", mesh.h}, {"grids", mesh.grids}};
  set_number(json, "seconds", mesh.seconds);
  for (const QuantityResult& quantity : quantities) json.emplace(quantity.path, to_json(quantity.meshes[at]));
  return json;
}

Json to_json(const QuantityResult& quantity) {
  const Order& order = quantity.order;
  Json json;
  set_number(json, "value", order.value, order.why);
  set_number(json, "low", order.low, order.why);
  set_number(json, "high", order.high, order.why);
  set_number(json, "constant", order.constant, order.why);
  json.update(Json{{"verdict", to_string(order.verdict)}, {"why", order.why}});
  set_number(json, "expected", quantity.expected.value, quantity.expected.why);
  json.update(Json{{"expected_why", quantity.expected.why},
                   {"sizes", order.sizes},
                   {"basis", quantity.exact ? "exact" : "extrapolated"}});
  return json;
}

Json to_json(const Extrapolated& limit) {
  Json json;
  set_numbers(json, {{"value", limit.value}, {"uncertainty", limit.uncertainty}});
  json.emplace("method", limit.method);
  return json;
}

Json to_json(const BudgetLine& line, const std::string& quantity, const MeshRow& mesh) {
  Json json{{"quantity", quantity}, {"cells", mesh.cells}, {"h", line.h}};
  set_numbers(json, {{"observed", line.observed},
                     {"discretisation", line.discretisation},
                     {"iteration", line.iteration},
                     {"rounding", line.rounding},
                     {"reference", line.reference},
                     {"trend", line.trend},
                     {"staircase", line.staircase}});
  return json;
}

bool has_exact(const SeriesResult& series) { return std::ranges::any_of(series.quantities, &QuantityResult::exact); }

bool has_limits(const SeriesResult& series) { return !std::ranges::all_of(series.quantities, &QuantityResult::exact); }

/// The number at a path of a row.
Number number_of(const PathNumbers& numbers, const std::string& path) {
  const auto found = std::ranges::find(numbers, path, &PathNumbers::value_type::first);
  return found == numbers.end() ? Number{} : found->second;
}

/// Short names of quantities in tables; other quantities keep their path.
std::string label(const std::string& path) {
  const auto found = std::ranges::find(error_quantities(), path, &ErrorQuantity::path);
  return found == error_quantities().end() ? path : found->label;
}

std::string error(double value) { return number_text(value, "{:+.1e}"); }
std::string size(double value) { return number_text(std::abs(value), "{:.1e}"); }

std::string cells_text(const std::array<solver::Index, 2>& cells) { return fmt::format("{} x {}", cells[0], cells[1]); }

std::string order_text(const Order& order) {
  if (!std::isfinite(order.value)) return "-";
  if (!std::isfinite(order.low) || !std::isfinite(order.high)) return fmt::format("{:.2f}", order.value);
  return fmt::format("{:.2f} [{:.2f}, {:.2f}]", order.value, order.low, order.high);
}

/// A line for each quantity: its error on the first and the last mesh, order, verdict and reason.
std::string orders_text(const SeriesResult& series) {
  const MeshRow& first = series.meshes.front();
  const MeshRow& last = series.meshes.back();
  std::string text = fmt::format("  {:<27} {:>9} {:>9}  {:<20} {:>8}  {}\n", "", cells_text(first.cells),
                                 cells_text(last.cells), "order [95 %]", "expected", "verdict");
  for (const QuantityResult& each : series.quantities) {
    text += fmt::format("  {:<27} {:>9} {:>9}  {:<20} {:>8}  {}\n", label(each.path), error(each.meshes.front().mean),
                        error(each.meshes.back().mean), order_text(each.order),
                        number_text(each.expected.value, "{:.1f}"), to_string(each.order.verdict));
  }
  text += fmt::format("  {:<27} {:>9} {:>9}  of one solve\n", "seconds", short_text(first.seconds),
                      short_text(last.seconds));
  for (const QuantityResult& each : series.quantities) {
    if (each.order.verdict != OrderVerdict::asymptotic)
      text += fmt::format("    {}: {}\n", label(each.path), each.order.why);
  }
  for (const QuantityResult& each : series.quantities) {
    if (!each.extrapolated) continue;
    text += fmt::format("    {} tends to {} +- {} ({})\n", label(each.path),
                        number_text(each.extrapolated->value, "{:.6g}"), size(each.extrapolated->uncertainty),
                        each.extrapolated->method);
  }
  return text;
}

/// The values from which errors are measured.
std::string basis_text(const SeriesResult& series) {
  const bool is_compared = series.meshes.size() > 1;
  if (!is_compared && !has_exact(series)) return "no exact answer: values";
  if (!is_compared && has_limits(series)) {
    return "errors against the exact answer where there is one, else values";
  }
  if (!has_exact(series)) return "errors against the extrapolated value";
  if (!has_limits(series)) return "errors against the exact answer";
  return "errors against the exact answer, where it says nothing against the extrapolated value";
}

/// The budget of the first quantity, which is the twist where there is one.
std::string budget_text(const SeriesResult& series) {
  if (series.quantities.empty()) return "";
  const QuantityResult& quantity = series.quantities.front();
  std::string text = fmt::format("  error budget: {}\n", label(quantity.path));
  text += fmt::format("  {:>13} {:>10} = {:>14} + {:>9}   +-{:>9} +-{:>10}   (the fitted trend {})\n", "cells",
                      "observed", "discretisation", "iteration", "rounding", "reference", "and the staircase");
  for (std::size_t i = 0; i < quantity.budget.size(); ++i) {
    const BudgetLine& line = quantity.budget[i];
    text += fmt::format("  {:>13} {:>10} = {:>14} + {:>9}   {:>11} {:>12}   ({:>16} {:>17})\n",
                        cells_text(series.meshes[i].cells), error(line.observed), error(line.discretisation),
                        error(line.iteration), size(line.rounding), size(line.reference), error(line.trend),
                        error(line.staircase));
  }
  return text;
}

/// The status of a run that did not converge.
std::string status_note(std::string status) {
  std::ranges::replace(status, '_', ' ');
  return status == "converged" ? "" : "   " + status;
}

std::string tolerances_text(const SeriesResult& series) {
  if (series.quantities.empty()) return "  no quantity of this scene can be followed\n";
  const auto& [path, is_error] = std::tie(series.quantities.front().path, series.quantities.front().exact);
  std::string text =
      fmt::format("  {:>13} {:>9} {:>12} {:>10} {:>12} {:>9} {:>12}  {}\n", "cells", "requested", "gap/energy",
                  "change", "applications", "seconds", label(path) + (is_error ? " error" : ""),
                  is_error ? "of it by stopping there" : "off the tightest run, relative");
  for (const StudyRow& row : *series.tolerances) {
    const Number value = number_of(row.numbers, path);
    text += fmt::format(
        "  {:>13} {:>9.0e} {:>12} {:>10} {:>12} {:>9} {:>12}  {}{}\n", cells_text(row.cells), row.requested,
        size(number_of(row.numbers, "certificate.gap")), size(number_of(row.numbers, "change")),
        number_text(number_of(row.numbers, "operator_applications"), "{:.6g}"), short_text(row.seconds),
        is_error ? error(value) : short_text(value), error(number_of(row.iteration, path)), status_note(row.status));
  }
  return text;
}

/// A line for each grid, where there is one mesh only.
std::string rows_text(const SeriesResult& series) {
  std::string text;
  for (const StudyRow& row : series.rows) {
    text += fmt::format("  {:>13} {}", cells_text(row.cells), row.status);
    for (const QuantityResult& each : series.quantities)
      text += fmt::format("  {}{} {}", label(each.path), each.exact ? " error" : "",
                          short_text(number_of(row.numbers, each.path)));
    text += "\n";
  }
  return text;
}

}  // namespace

Json to_json(const SeriesResult& series) {
  Json json{{"set", series.set},
            {"tolerance", series.tolerance},
            {"tightened", series.tightened},
            {"basis", has_exact(series) ? "exact" : "extrapolated"}};
  set_number(json, "reference_uncertainty", series.reference_uncertainty);
  Json meshes = Json::array();
  for (std::size_t i = 0; i < series.meshes.size(); ++i)
    meshes.push_back(to_json(series.meshes[i], series.quantities, i));
  Json orders = Json::object();
  Json limits = Json::object();
  Json budget = Json::array();
  for (const QuantityResult& each : series.quantities) {
    orders.emplace(each.path, to_json(each));
    if (each.extrapolated) limits.emplace(each.path, to_json(*each.extrapolated));
    for (std::size_t i = 0; i < each.budget.size(); ++i)
      budget.push_back(to_json(each.budget[i], each.path, series.meshes[i]));
  }
  json.update(Json{{"failed_runs", series.failed_runs.json()},
                   {"rows", series.rows},
                   {"meshes", meshes},
                   {"order", orders},
                   {"extrapolated", limits},
                   {"budget", budget}});
  if (series.tolerances) json.emplace("tolerances", *series.tolerances);
  return json;
}

Json to_json(const StudyResult& result) {
  Json series = Json::object();
  for (const SeriesResult& each : result.series) series[each.name] = to_json(each);
  return {{"name", result.name},
          {"scene", result.scene},
          {"shifts", result.shifts},
          {"series", series},
          {"failed_runs", result.failed_runs.json()},
          {"provenance", result.provenance}};
}

std::string study_text(const StudyResult& result) {
  std::string text = fmt::format("{}: {} series\n", result.name, result.series.size());
  if (const std::string failures = result.failed_runs.text(); !failures.empty()) {
    text +=
        fmt::format("{}; missing values are shown as \"-\", and the same command tries these runs again\n", failures);
  }
  for (const SeriesResult& series : result.series) {
    text += fmt::format("\n{} ({}; tolerance {:g}{})\n", series.name, basis_text(series), series.tolerance,
                        series.tightened > 0 ? ", tightened by the study: the iteration error showed in an error" : "");
    if (series.tolerances) text += tolerances_text(series);
    if (series.meshes.size() > 1) {
      text += orders_text(series) + budget_text(series);
    } else if (!series.tolerances) {
      text += rows_text(series);
    }
  }
  return text;
}

}  // namespace slipstick::convergence
