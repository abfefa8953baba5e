#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "convergence/orders/expected_order.hpp"
#include "convergence/runs/failed_runs.hpp"
#include "convergence/studies/study.hpp"

namespace slipstick::convergence {
namespace {

/// Short names of what is shown in tables; other quantities keep their path.
std::string label(const std::string& path) {
  const auto found = std::ranges::find(error_quantities(), path, &ErrorQuantity::path);
  return found == error_quantities().end() ? path : found->label;
}

std::string error(const Json& value) { return number_text(value, "{:+.1e}"); }

std::string size(const Json& value) {
  return value.is_number() ? fmt::format("{:.1e}", std::abs(value.get<double>())) : "-";
}

std::string cells_text(const Json& cells) {
  return fmt::format("{} x {}", cells[0].get<long>(), cells[1].get<long>());
}

std::string order_text(const Json& order) {
  if (!order["value"].is_number()) return "-";
  if (!order["low"].is_number() || !order["high"].is_number())
    return fmt::format("{:.2f}", order["value"].get<double>());
  return fmt::format("{:.2f} [{:.2f}, {:.2f}]", order["value"].get<double>(), order["low"].get<double>(),
                     order["high"].get<double>());
}

/// A line a quantity: its error on the first and the last mesh, order, verdict and why.
std::string orders_text(const Json& series) {
  const Json& meshes = series["meshes"];
  std::string text =
      fmt::format("  {:<27} {:>9} {:>9}  {:<20} {:>8}  {}\n", "", cells_text(meshes.front()["cells"]),
                  cells_text(meshes.back()["cells"]), "order [95 %]", "expected", "verdict");
  for (const auto& [path, order] : series["order"].items()) {
    text += fmt::format(
        "  {:<27} {:>9} {:>9}  {:<20} {:>8}  {}\n", label(path), error(meshes.front()[path]["mean"]),
        error(meshes.back()[path]["mean"]), order_text(order),
        order["expected"].is_number() ? fmt::format("{:.1f}", order["expected"].get<double>()) : "-",
        order["verdict"].get<std::string>());
  }
  text += fmt::format("  {:<27} {:>9} {:>9}  of one solve\n", "seconds",
                      short_text(meshes.front()["seconds"]), short_text(meshes.back()["seconds"]));
  for (const auto& [path, order] : series["order"].items()) {
    if (order["verdict"] == "asymptotic") continue;
    text += fmt::format("    {}: {}\n", label(path), order["why"].get<std::string>());
  }
  for (const auto& [path, limit] : series["extrapolated"].items()) {
    text += fmt::format("    {} tends to {} +- {} ({})\n", label(path), number_text(limit["value"]),
                        size(limit["uncertainty"]), limit["method"].get<std::string>());
  }
  return text;
}

/// The values that errors are measured from.
std::string basis_text(const Json& series) {
  const bool is_compared = series["meshes"].size() > 1;
  if (!is_compared && series["basis"] != "exact") return "no exact answer: values";
  if (!is_compared && !series["extrapolated"].empty()) {
    return "errors against the exact answer where there is one, else values";
  }
  if (series["basis"] != "exact") return "errors against the extrapolated value";
  if (series["extrapolated"].empty()) return "errors against the exact answer";
  return "errors against the exact answer, where it says nothing against the extrapolated value";
}

/// The budget of the first quantity, which is the twist where there is one.
std::string budget_text(const Json& series) {
  const Json& budget = series["budget"];
  if (budget.empty()) return "";
  const Json& quantity = budget.front()["quantity"];
  std::string text = fmt::format("  error budget: {}\n", label(quantity.get<std::string>()));
  text +=
      fmt::format("  {:>13} {:>10} = {:>14} + {:>9}   +-{:>9} +-{:>10}   (the fitted trend {})\n", "cells",
                  "observed", "discretisation", "iteration", "rounding", "reference", "and the staircase");
  for (const Json& line : budget) {
    if (line["quantity"] != quantity) continue;
    text += fmt::format("  {:>13} {:>10} = {:>14} + {:>9}   {:>11} {:>12}   ({:>16} {:>17})\n",
                        cells_text(line["cells"]), error(line["observed"]), error(line["discretisation"]),
                        error(line["iteration"]), size(line["rounding"]), size(line["reference"]),
                        error(line["trend"]), error(line["staircase"]));
  }
  return text;
}

/// Behind the numbers of a run; empty where it converged.
std::string status_note(std::string status) {
  std::ranges::replace(status, '_', ' ');
  return status == "converged" ? "" : "   " + status;
}

std::string tolerances_text(const Json& series) {
  const Json& rows = series["tolerances"];
  if (series["order"].empty()) return "  no quantity of this scene can be followed\n";
  const std::string quantity = series["order"].items().begin().key();
  const bool is_error = series["order"][quantity]["basis"] == "exact";
  std::string text = fmt::format("  {:>13} {:>9} {:>12} {:>10} {:>12} {:>9} {:>12}  {}\n", "cells",
                                 "requested", "gap/energy", "change", "applications", "seconds",
                                 label(quantity) + (is_error ? " error" : ""),
                                 is_error ? "of it by stopping there" : "off the tightest run, relative");
  for (const Json& row : rows) {
    text +=
        fmt::format("  {:>13} {:>9.0e} {:>12} {:>10} {:>12} {:>9} {:>12}  {}{}\n", cells_text(row["cells"]),
                    row["requested"].get<double>(), size(row["certificate.gap"]), size(row["change"]),
                    number_text(row["operator_applications"]), short_text(row["seconds"]),
                    is_error ? error(row[quantity]) : short_text(row[quantity]),
                    error(row["iteration"][quantity]), status_note(row["status"].get<std::string>()));
  }
  return text;
}

/// A line a grid, where there is no sequence of meshes to judge.
std::string rows_text(const Json& series) {
  std::string text;
  for (const Json& row : series["rows"]) {
    text += fmt::format("  {:>13} {}", cells_text(row["cells"]), row["status"].get<std::string>());
    for (const auto& [path, order] : series["order"].items())
      text += fmt::format("  {}{} {}", label(path), order["basis"] == "exact" ? " error" : "",
                          short_text(row[path]));
    text += "\n";
  }
  return text;
}

}  // namespace

std::string study_text(const Json& result) {
  std::string text =
      fmt::format("{}: {} series\n", result["name"].get<std::string>(), result["series"].size());
  if (const std::string failures = failed_runs_text(result); !failures.empty()) {
    text += fmt::format("{}; what they were to tell is missing (-), and the same command tries them again\n",
                        failures);
  }
  for (const auto& [name, series] : result["series"].items()) {
    text += fmt::format(
        "\n{} ({}; tolerance {:g}{})\n", name, basis_text(series), series["tolerance"].get<double>(),
        series["tightened"].get<int>() > 0 ? ", tightened by the study: stopping earlier showed in an error"
                                           : "");
    if (series.contains("tolerances")) text += tolerances_text(series);
    if (series["meshes"].size() > 1) {
      text += orders_text(series) + budget_text(series);
    } else if (!series.contains("tolerances")) {
      text += rows_text(series);
    }
  }
  return text;
}

}  // namespace slipstick::convergence
