#include "convergence/report/scene_cost.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "convergence/exchange/solver_program.hpp"
#include "convergence/orders/order.hpp"
#include "convergence/programs/package_module.hpp"
#include "convergence/results/provenance.hpp"
#include "convergence/results/result_parts.hpp"
#include "convergence/runs/run_spec.hpp"
#include "convergence/solve/accurate_solve.hpp"
#include "solver/input/field_file.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/whole_file.hpp"
#include "solver/scene/scene_keys.hpp"

namespace slipstick::convergence {
namespace {

using solver::Index;

const double kCostTolerances[] = {1e-3, 1e-6, 1e-9};
const double kWanted[] = {1e-2, 1e-3, 1e-4};

/// The choices of `solve --accuracy`, a row for each of some errors.
Json choices(const solver::Scene& scene) {
  Json rows = Json::array();
  for (const double wanted : kWanted) {
    Json& row = rows.emplace_back(Json{{"wanted", wanted}});
    try {
      const Json plan = to_json(accuracy_plan(scene, {wanted}));
      for (const char* key : {"cells", "tolerance", "grids", "seconds"}) {
        if (plan.contains(key)) row[key] = plan[key];
      }
      if (plan.contains("note")) row["remark"] = plan["note"];
    } catch (const solver::InputError& error) {
      set_missing(row, "cells", error.what());
    }
  }
  return rows;
}

/// A method or a program, the overrides that select it, and its finest mesh.
struct Contender {
  std::string name;
  std::vector<std::string> overrides;
  Index most_cells;
};

std::vector<Contender> contenders(const PageScene& at) {
  const solver::Scene& scene = at.scene;
  const Index finest = at.meshes.answer.back();
  std::vector<Contender> all;
  for (const auto& [name, method] : solver::kMethods) {
    all.push_back({name,
                   {fmt::format("solver.method=\"{}\"", name), kNoProgram},
                   method == scene.solver.method ? finest : at.size.method_cells});
  }
  if (!scene.solver.program.empty()) all.push_back({read_solver_program(scene.solver.program).name, {}, finest});
  return all;
}

/// The error of an answer of another program, by the first number that it has.
void compare(PageProgram& row, const Json& result, const std::vector<std::string>& numbers,
             const std::vector<PageNumber>& known) {
  for (const std::string& number : numbers) {
    const PageNumber* const reference = find_row(known, number);
    const double error = reference == nullptr
                             ? kNaN
                             : std::abs(size_at(result, number) / reference->reference - 1.0) + reference->uncertainty;
    row.number = number;
    row.error = number_or(error, is_failed(result) ? "there is no answer" : "no reference is known");
    if (std::isfinite(error)) return;
  }
}

/// Every method, and the program of the scene if it has one, on several meshes and to several tolerances.
Cost error_against_time(const PageScene& at, const Reference& reference, const ProcessPool& pool) {
  Cost cost{.number = reference.number,
            .reference_uncertainty = number_or(reference.uncertainty, "no reference is known"),
            .choices = choices(at.scene)};
  std::vector<RunSpec> runs;
  for (const Contender& each : contenders(at)) {
    for (const Index cells : at.meshes.answer) {
      if (cells > each.most_cells) continue;
      for (const double tolerance : kCostTolerances) {
        RunSpec& run = runs.emplace_back(changed(at.on(cells), each.overrides));
        run.overrides.push_back(fmt::format("solver.tolerance={}", tolerance));
        cost.points.push_back({.method = each.name, .cells = cells, .tolerance = tolerance});
      }
    }
  }
  const std::vector<Json> results = to_json(pool.run_or_refuse(runs));
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Json& result = results[i];
    const std::string why = is_failed(result) ? text_at(result, "message") : "not a number";
    const double found = is_converged(result) ? size_at(result, reference.number) : kNaN;
    cost.points[i].status = text_at(result, "status");
    cost.points[i].seconds = number_or(seconds_of(result), why);
    cost.points[i].error = number_or(std::abs(found / reference.value - 1.0) + reference.uncertainty,
                                     is_converged(result) ? "no reference is known" : why);
  }
  return cost;
}

/// The answers of this program and of others on the meshes of a page of another program.
std::vector<PageProgram> answers_of_programs(const PageScene& at, const Contest& contest, const ProcessPool& pool) {
  std::vector<BesideMethod> all{{"slipstick", kNoProgram}};
  all.insert(all.end(), contest.programs.begin(), contest.programs.end());
  std::vector<RunSpec> runs;
  std::vector<PageProgram> rows;
  for (const BesideMethod& each : all) {
    for (const Index cells : meshes_of(at.scene, for_program(at.size)).answer) {
      runs.push_back(changed(at.on(cells), {each.override}));
      rows.push_back({.name = each.name, .cells = cells});
    }
  }
  const std::vector<Json> results = to_json(pool.run_or_refuse(runs));
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Json& result = results[i];
    PageProgram& row = rows[i];
    const auto program = result.find("program");
    const bool foreign = program != result.end();
    row.status = text_at(result, "status");
    row.message = text_at(result, "message");
    row.version = foreign ? text_at(*program, "version") : "";
    row.seconds = number_or(seconds_of(result), "there is no answer");
    row.cpu_seconds = number_or(foreign ? number_at(result, "program.cpu_seconds") : kNaN, "it was not counted");
    const bool only_pressure = foreign && text_at(*program, "fields") == "pressure";
    compare(
        row, result,
        only_pressure ? std::vector<std::string>{"approach", "peak_pressure"} : std::vector{contest.reference.number},
        contest.numbers);
  }
  return rows;
}

/// families: of each operator the pairs of cells and seconds of each repetition. Without the Python package
/// no numbers, and the reason.
Json operator_times(const Json& families) {
  try {
    return run_package_module("speed.crossovers", {{"families", families}, {"slow", "direct"}, {"quick", "dcfft"}})
        .result;
  } catch (const std::runtime_error& failure) {
    Json none{{"rows", Json::array()}, {"remark", failure.what()}};
    for (const char* number : {"cells", "low", "high"}) set_missing(none, number, failure.what());
    return none;
  }
}

/// Whole solves with direct sums and with convolution on small meshes of the scene.
Json direct_against_dcfft(const PageScene& at, const ProcessPool& pool) {
  constexpr const char* kKinds[] = {"dcfft", "direct"};
  std::vector<RunSpec> runs;
  for (const char* kind : kKinds) {
    for (const double cells : at.size.operator_cells) {
      for (int repetition = 1; repetition <= at.size.repetitions; ++repetition) {
        RunSpec& run = runs.emplace_back(at.on(static_cast<Index>(cells)));
        run.overrides.push_back(fmt::format("solver.operator=\"{}\"", kind));
        run.overrides.push_back(fmt::format("name=\"repetition {}\"", repetition));  // else it is the same run
      }
    }
  }
  const std::vector<Json> results = to_json(pool.run_or_refuse(runs));
  Json families;
  auto result = results.begin();
  for (const char* kind : kKinds) {
    for (const double cells : at.size.operator_cells) {
      std::vector<double> seconds;
      for (int k = 0; k < at.size.repetitions; ++k) seconds.push_back(seconds_of(*result++));
      families[kind].push_back({cells, seconds});
    }
  }
  return operator_times(families);
}

std::string shown_number(double value, const char* unit) {
  return std::isfinite(value) ? fmt::format("{:.2e}{}", value, unit) : std::string("-");
}

}  // namespace

Costs costs_of(const PageScene& at, const Contest& contest, const ProcessPool& pool) {
  Costs costs{.cost = error_against_time(at, contest.reference, pool)};
  if (!contest.programs.empty()) costs.programs = answers_of_programs(at, contest, pool);
  if (at.own) costs.operators = direct_against_dcfft(at, pool);
  return costs;
}

SceneCosts scene_costs(const RunSpec& base, const PageSize& size, const std::vector<BesideMethod>& programs,
                       const std::filesystem::path& folder, const ProcessPool& pool) {
  const PageScene at = page_scene(base, size);
  if (at.meshes.given) {
    throw solver::InputError(at.scene.source.string(),
                             "its files have its grid; allowed: a scene that can be solved on other meshes");
  }
  solver::make_folder(folder);
  const std::vector<Json> results = solve_answer(at, folder / ("answer" + solver::fields_ending()), pool);
  SceneCosts costs{.provenance = provenance(std::max(1, at.scene.solver.threads)), .scene = at.scene.name};
  costs.numbers = number_rows(at.scene, results, scene_studies(at, pool).front());
  costs.costs = costs_of(at, {programs, costs.numbers, reference_of(results.back(), costs.numbers)}, pool);
  return costs;
}

std::string costs_text(const SceneCosts& costs) {
  const auto& [cost, programs, operators] = costs.costs;
  std::string text = fmt::format(
      "{}: error of {}, from a value that is known to {}\n  {:20} {:>6} {:>10} {:>10} {:>12}\n", costs.scene,
      cost.number, shown_number(cost.reference_uncertainty, ""), "method", "cells", "tolerance", "error", "time");
  for (const CostPoint& point : cost.points) {
    text += fmt::format("  {:20} {:>6} {:>10.0e} {:>10} {:>12}{}\n", point.method, point.cells, point.tolerance,
                        shown_number(point.error, ""), shown_number(point.seconds, " s"),
                        point.status == "converged" ? "" : "  " + point.status);
  }
  for (const PageProgram& row : programs.value_or(std::vector<PageProgram>{})) {
    text +=
        fmt::format("  {:20} {:>6} {:>10} {:>10} {:>12}  {} {}\n", row.name, row.cells, "", shown_number(row.error, ""),
                    shown_number(row.seconds, " s"), row.number, row.status == "converged" ? "" : row.status);
  }
  if (!operators) return text;
  const double crossover = number_at(*operators, "cells");
  text += std::isfinite(crossover)
              ? fmt::format("  convolution is faster than direct summation from {:.3g} cells a side on\n", crossover)
              : fmt::format("  convolution against direct summation: {}\n", text_at(*operators, "remark"));
  return text;
}

}  // namespace slipstick::convergence
