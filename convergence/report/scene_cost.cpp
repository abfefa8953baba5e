#include "convergence/report/scene_cost.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "convergence/exchange/solver_program.hpp"
#include "convergence/orders/growth.hpp"
#include "convergence/results/provenance.hpp"
#include "convergence/results/quantity.hpp"
#include "convergence/runs/failed_runs.hpp"
#include "convergence/runs/run_batch.hpp"
#include "convergence/solve/accurate_solve.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/whole_file.hpp"
#include "solver/scene/scene_keys.hpp"

namespace slipstick::convergence {
namespace {

using solver::Index;

const double kCostTolerances[] = {1e-3, 1e-6, 1e-9};
const double kAsked[] = {1e-2, 1e-3, 1e-4};

/// What `--accuracy` would take, a row for each error asked for.
Json choices(const solver::Scene& scene) {
  Json rows = Json::array();
  for (const double wanted : kAsked) {
    Json& row = rows.emplace_back(Json{{"wanted", wanted}});
    try {
      const AccuracyTarget target{wanted, AccuracyOf::twist};
      require_reachable(scene, target);
      const Json plan = accuracy_plan(scene, target);
      for (const char* key : {"cells", "tolerance", "grids", "seconds"}) {
        if (plan.contains(key)) row[key] = plan[key];
      }
      if (const std::string note = note_on(scene); !note.empty()) row["remark"] = note;
    } catch (const solver::InputError& error) {
      set_missing(row, "cells", error.what());
    }
  }
  return rows;
}

/// A page's row for a number; null: it has none.
const Json* find_row(const Json& numbers, const std::string& key) {
  for (const Json& row : numbers) {
    if (row["key"] == key) return &row;
  }
  return nullptr;
}

/// What solves the scene: its name, the overrides that ask for it, and its finest mesh.
struct Contender {
  std::string name;
  std::vector<std::string> overrides;
  Index most_cells;
};

std::vector<Contender> contenders(const solver::Scene& scene, Index finest, const PageSize& size) {
  std::vector<Contender> all;
  for (const auto& [name, method] : solver::kMethods) {
    all.push_back({name,
                   {fmt::format("solver.method=\"{}\"", name), kNoProgram},
                   method == scene.method ? finest : size.method_cells});
  }
  if (!scene.program.empty()) all.push_back({read_solver_program(scene.program).name, {}, finest});
  return all;
}

}  // namespace

Json error_against_time(const RunSpec& base, const solver::Scene& scene, const std::vector<Index>& meshes,
                        const Reference& reference, const PageSize& size, const ProcessPool& pool) {
  Json json{{"number", reference.number}, {"points", Json::array()}};
  set_number(json, "reference_uncertainty", reference.uncertainty, "no reference is known");
  RunBatch batch;
  for (const Contender& each : contenders(scene, meshes.back(), size)) {
    for (const Index cells : meshes) {
      if (cells > each.most_cells) continue;
      for (const double tolerance : kCostTolerances) {
        RunSpec run = changed(base, each.overrides);
        run.overrides.push_back(cells_override(scene, cells));
        run.overrides.push_back(fmt::format("solver.tolerance={}", tolerance));
        batch.add_or_refuse(run, [&json, &reference, method = each.name, cells,
                                  tolerance](const Json& result) {
          Json& point = json["points"].emplace_back(Json{
              {"method", method}, {"cells", cells}, {"tolerance", tolerance}, {"status", result["status"]}});
          const std::string why = is_failed(result) ? result["message"].get<std::string>() : "not a number";
          set_number(point, "seconds", seconds_of(result), why);
          const double found = is_converged(result) ? size_at(result, reference.number) : kNaN;
          set_number(point, "error", std::abs(found / reference.value - 1.0) + reference.uncertainty,
                     is_converged(result) ? "no reference is known" : why);
        });
      }
    }
  }
  batch.run(pool);
  json["choices"] = choices(scene);
  return json;
}

Json answers_beside(const RunSpec& base, const solver::Scene& scene, const std::vector<Index>& meshes,
                    const Beside& beside, const ProcessPool& pool) {
  Json rows = Json::array();
  std::vector<BesideMethod> all{{"slipstick", kNoProgram}};
  all.insert(all.end(), beside.programs.begin(), beside.programs.end());
  RunBatch batch;
  for (const auto& each : all) {
    for (const Index cells : meshes) {
      const RunSpec run = changed(base, {each.override, cells_override(scene, cells)});
      batch.add_or_refuse(run, [&rows, &beside, name = each.name, cells](const Json& result) {
        Json& row = rows.emplace_back(Json{{"name", name}, {"cells", cells}, {"status", result["status"]}});
        row["version"] = "";
        row["message"] = result.value("message", "");
        const bool foreign = result.contains("program");
        if (foreign) row["version"] = result["program"]["version"];
        set_number(row, "seconds", seconds_of(result), "there is no answer");
        set_number(row, "cpu_seconds", foreign ? number_at(result, "program.cpu_seconds") : kNaN,
                   "it was not counted");
        const bool pressure = foreign && result["program"]["fields"] == "pressure";
        for (const std::string& number :
             pressure ? std::vector<std::string>{"approach", "peak_pressure"} : std::vector{beside.number}) {
          const Json* const known = find_row(beside.numbers, number);
          row["number"] = number;
          set_number(row, "error",
                     known == nullptr
                         ? kNaN
                         : std::abs(size_at(result, number) / number_at(*known, "reference") - 1.0) +
                               number_at(*known, "uncertainty"),
                     is_failed(result) ? "there is no answer" : "no reference is known");
          if (row["error"].is_number()) break;
        }
      });
    }
  }
  batch.run(pool);
  return rows;
}

Json direct_against_dcfft(const RunSpec& base, const solver::Scene& scene, const PageSize& size,
                          const ProcessPool& pool) {
  std::map<std::string, std::map<double, std::vector<double>>> seconds;
  RunBatch batch;
  for (const char* kind : {"direct", "dcfft"}) {
    for (const double cells : size.operator_cells) {
      for (int repetition = 1; repetition <= size.repetitions; ++repetition) {
        RunSpec run = changed(base, {cells_override(scene, static_cast<Index>(cells))});
        run.overrides.push_back(fmt::format("solver.operator=\"{}\"", kind));
        run.overrides.push_back(fmt::format("name=\"repetition {}\"", repetition));  // it is solved again
        batch.add_or_refuse(
            run, [&into = seconds[kind][cells]](const Json& result) { into.push_back(seconds_of(result)); });
      }
    }
  }
  batch.run(pool);
  std::map<std::string, Family> families;
  Json json{{"rows", Json::array()}};
  for (const auto& [kind, by_cells] : seconds) {
    for (const auto& [cells, times] : by_cells) {
      families[kind].push_back({cells, times});
      const TypicalSeconds time = typical(times);
      Json& row = json["rows"].emplace_back(Json{{"operator", kind}, {"cells", cells}});
      set_number(row, "seconds", time.seconds, "it did not solve");
      set_number(row, "low", time.low, "one repetition");
      set_number(row, "high", time.high, "one repetition");
    }
  }
  const Crossover crossover = find_crossover(families["direct"], families["dcfft"]);
  const std::string outside = crossover.remark.empty() ? "outside the measured sizes" : crossover.remark;
  set_number(json, "cells", crossover.cells, outside);
  set_number(json, "low", crossover.low, outside);
  set_number(json, "high", crossover.high, outside);
  json["remark"] = crossover.remark;
  return json;
}

Json scene_costs(const PageRequest& request, const std::filesystem::path& folder, const ProcessPool& pool) {
  const RunSpec& base = request.base;
  const solver::Scene scene = solver::read_scene(base.scene, base.overrides);
  const Meshes meshes = meshes_of(scene, request.size);
  if (meshes.given) {
    throw solver::InputError(scene.source.string(),
                             "its files have its grid; allowed: a scene that can be solved on other meshes");
  }
  solver::make_folder(folder);
  const std::vector<Json> results = solve_answer(base, scene, meshes, folder / "answer.h5", pool);
  Json costs{{"provenance", provenance(std::max(1, scene.threads))}, {"scene", scene.name}};
  costs["numbers"] =
      number_rows(scene, results, scene_studies(base, scene, meshes, request.size, pool).front());
  const Reference reference = reference_of(results.back(), costs["numbers"]);
  costs["cost"] = error_against_time(base, scene, meshes.answer, reference, request.size, pool);
  if (!request.beside.empty()) {
    const Meshes coarse = meshes_of(scene, for_program(request.size));
    costs["programs"] = answers_beside(base, scene, coarse.answer,
                                       {request.beside, costs["numbers"], reference.number}, pool);
  }
  costs["operators"] = direct_against_dcfft(base, scene, request.size, pool);
  return costs;
}

std::string costs_text(const Json& costs) {
  const auto shown = [](const Json& value, const char* unit) {
    return value.is_number() ? fmt::format("{:.2e}{}", value.get<double>(), unit) : std::string("-");
  };
  std::string text = fmt::format(
      "{}: error of {}, from a value that is known to {}\n  {:20} {:>6} {:>10} {:>10} {:>12}\n",
      costs["scene"].get<std::string>(), costs["cost"]["number"].get<std::string>(),
      shown(costs["cost"]["reference_uncertainty"], ""), "method", "cells", "tolerance", "error", "time");
  for (const Json& point : costs["cost"]["points"]) {
    text += fmt::format("  {:20} {:>6} {:>10.0e} {:>10} {:>12}{}\n", point["method"].get<std::string>(),
                        point["cells"].get<Index>(), point["tolerance"].get<double>(),
                        shown(point["error"], ""), shown(point["seconds"], " s"),
                        point["status"] == "converged" ? "" : "  " + point["status"].get<std::string>());
  }
  for (const Json& row : costs.value("programs", Json::array())) {
    text += fmt::format("  {:20} {:>6} {:>10} {:>10} {:>12}  {} {}\n", row["name"].get<std::string>(),
                        row["cells"].get<Index>(), "", shown(row["error"], ""), shown(row["seconds"], " s"),
                        row["number"].get<std::string>(),
                        row["status"] == "converged" ? "" : row["status"].get<std::string>());
  }
  const Json& crossing = costs["operators"];
  text += crossing["cells"].is_number()
              ? fmt::format("  convolution overtakes direct summation from {:.3g} cells a side on\n",
                            crossing["cells"].get<double>())
              : fmt::format("  convolution against direct summation: {}\n",
                            crossing["remark"].get<std::string>());
  return text;
}

}  // namespace slipstick::convergence
