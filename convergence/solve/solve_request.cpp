#include "convergence/solve/solve_request.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <nlohmann/json.hpp>
#include <tuple>

#include "convergence/oracle/oracle.hpp"
#include "convergence/programs/python_script.hpp"
#include "convergence/programs/temporary_folder.hpp"
#include "convergence/results/exact_result.hpp"
#include "convergence/results/output.hpp"
#include "convergence/results/record_text.hpp"
#include "convergence/results/solution_fields.hpp"
#include "convergence/runs/run_spec.hpp"
#include "convergence/runs/solve_scene.hpp"
#include "convergence/solve/accurate_solve.hpp"
#include "convergence/solve/checkpoint.hpp"
#include "convergence/solve/continuum.hpp"
#include "convergence/solve/uncertainty.hpp"
#include "convergence/system/machine.hpp"
#include "solver/cache/solve_cache.hpp"
#include "solver/history/history_state.hpp"
#include "solver/input/field_file.hpp"
#include "solver/input/input_error.hpp"
#include "solver/solve.hpp"

namespace slipstick::convergence {
namespace {

constexpr std::string_view kStep = "{step}";

/// Rewrites one line on a terminal; writes nothing to a file or pipe.
void show_progress(int iteration, double change) {
  if (isatty(STDERR_FILENO) != 0) std::cerr << fmt::format("\r\033[Kiteration {}, change {:.1e}\r", iteration, change);
}

/// The cells of each step, in a temporary folder.
std::string file_of_each_step() { return "fields-{step}" + std::string(solver::fields_ending()); }

/// Writes fields and figure on all ranks; write_fields writes the cells to a file. The last step's fields of
/// a history with one file a step were written at the end of that step.
template <typename WriteFields>
void write_files(const SolveRequest& request, const Json& result, const WriteFields& write_fields) {
  const auto& [fields, figure, loop, cells_of_steps] = request.files;
  if (!fields.empty() && !has_step(fields)) write_fields(fields);
  if (cells_of_steps && request.ranks.first())
    draw_solve(figure, result, *cells_of_steps / file_of_each_step().c_str());
  if (figure.empty() || cells_of_steps) return;
  const std::string ending = solver::fields_ending();
  if (!request.ranks.first()) return write_fields(figure + ending);  // its cells go to the first rank's file
  const TemporaryFolder folder;
  const std::filesystem::path cells = folder / ("fields" + ending).c_str();
  write_fields(cells);
  draw_solve(figure, result, cells);
}

/// The names of its columns are those that `check` reads from a loop.
std::string loop_table(const SolveRecord& record) {
  std::string table = "step,normal_load,moment,rotation,force_1,force_2,displacement_1,displacement_2,dissipated\n";
  std::size_t number = 0;
  const auto add = [&](const EndRecord& end) {
    const auto& [force, displacement] = std::tie(end.loads.force.values, end.loads.displacement.values);
    table += fmt::format("{},{},{},{},{},{},{},{},{}\n", ++number, end.contact.normal_load.value,
                         end.loads.moment.value, end.loads.twist_angle.value, force[0], force[1], displacement[0],
                         displacement[1], end.energy.dissipated.value);
  };
  if (!record.history) add(record.end);
  for (const StepRecord& step : record.history.value_or(HistoryRecord()).steps) add(step.end);
  return table;
}

/// Writes the loop, and the reasons to doubt the scene to standard error.
void report(const SolveRequest& request, const SolveRecord& record) {
  if (!request.ranks.first()) return;
  for (const std::string& warning : record.warnings)
    std::cerr << plain_text(fmt::format("slipstick: warning: {}\n", warning));
  if (!request.files.loop.empty()) write_option_file("--loop", request.files.loop, loop_table(record));
}

void write_answer(const SolveRequest& request, const SolvedScene& answer, std::ostream& text, const Json& result) {
  text << solve_text(answer.record, solver::Units(request.scene.units));
  report(request, answer.record);
  write_files(request, result, [&](const auto& file) { write_solution_fields(file, answer.solution, answer.exact); });
}

/// Solves. If an error ends a history after some steps, the result gets these.
SolvedScene solve_or_keep_steps(const solver::Scene& scene, SolveSceneOptions options, Json& result) {
  SolveRecord incomplete;
  options.incomplete = &incomplete;
  try {
    return solve_scene(scene, options);
  } catch (const solver::InputError&) {
    if (incomplete.history) result = to_json(incomplete);
    throw;
  }
}

/// All: the command has checked that the scene's own program may run.
AllowedPrograms allowed_programs() { return {.all = true, .tied_by = own_program()}; }

/// Options of a solve on a grid that writes the fields of each step if the request names one file a step.
SolveSceneOptions grid_options(const SolveRequest& request, std::size_t finished_steps = 0) {
  const auto write_step = [&files = request.files, step = finished_steps](const solver::Solution& at,
                                                                          const OracleAnswer& exact) mutable {
    ++step;
    if (has_step(files.fields)) write_solution_fields(file_of_step(files.fields, step), at, exact);
    if (files.cells_of_steps) {
      const std::string cells = file_of_step(file_of_each_step(), step);
      write_solution_fields(*files.cells_of_steps / cells.c_str(), at, exact);
    }
  };
  return {.progress = request.ranks.first() ? show_progress : nullptr,
          .on_step = write_step,
          .ranks = request.ranks,
          .programs = allowed_programs()};
}

/// The steps that the checkpoint has; null: none. Throws InputError for a file that exists without --resume.
std::shared_ptr<const FinishedSteps> finished_steps(const Checkpoint& checkpoint, const SolveRequest& request) {
  const std::string& file = request.checkpoint.file;
  if (!request.checkpoint.resume && std::filesystem::exists(file)) {
    throw solver::InputError("--checkpoint " + file,
                             "exists already; allowed: --resume, to continue from it, or another file");
  }
  std::shared_ptr<const FinishedSteps> finished = checkpoint.read();
  if (finished && request.ranks.first()) {
    std::cerr << plain_text(
        fmt::format("slipstick: continues after step {}, from {}\n", finished->state->finished, file));
  }
  return finished;
}

/// Solves with a checkpoint after steps.
SolvedScene solve_with_checkpoint(const SolveRequest& request, Json& result) {
  if (request.scene.solver.rounding_seed != 0) {
    throw solver::InputError(request.scene.source.string(), "solver.rounding_seed",
                             std::to_string(request.scene.solver.rounding_seed),
                             "left out with --checkpoint: rounding_seed cannot be resumed, its random stream "
                             "restarts");
  }
  Checkpoint checkpoint(request.checkpoint.file,
                        prepare_run({.scene = request.source.file, .overrides = request.source.overrides}));
  const auto resumed = finished_steps(checkpoint, request);
  SolveSceneOptions options = grid_options(request, resumed ? resumed->state->finished : 0);
  options.resumed = resumed;
  if (request.ranks.first()) {
    options.on_state = [&](const solver::HistoryState& state, const std::vector<StepRecord>& steps) {
      checkpoint.offer(state, steps);
    };
  }
  return solve_or_keep_steps(request.scene, options, result);
}

/// Fills the result, and writes text and files. cycle: what the stresses need of the last cycle.
void write_solved(const SolveRequest& request, const SolvedScene& solved,
                  const std::vector<solver::SolutionFields>& cycle, std::ostream& text, Json& result) {
  result = to_json(solved.record);
  if (!request.stresses.file.empty())
    result["stresses"] = write_stresses(request.stresses, request.scene, solved.solution, cycle);
  write_answer(request, solved, text, result);
  if (!result.contains("stresses")) return;
  text << stresses_text(result["stresses"]);
  if (request.stresses.figure.empty()) return;
  for (const solver::Body body : request.stresses.bodies(request.scene))
    draw_stresses(request.stresses.figure_name(body), request.stresses.name(0, body));
}

/// Adds pressure and tractions at the end of each step of the last cycle to `states`.
void keep_last_cycle(SolveSceneOptions& options, int last, std::vector<solver::SolutionFields>& states) {
  options.on_step = [&states, last, then = std::move(options.on_step)](const solver::Solution& at,
                                                                       const OracleAnswer& exact) {
    if (at.cycle == last) {
      solver::SolutionFields& state = states.emplace_back();
      state.grid = at.grid;
      state.pressure = at.pressure;
      state.traction = at.traction;
    }
    then(at, exact);
  };
}

SolveRecord answer_on_grid(const SolveRequest& request, std::ostream& text, Json& result) {
  if (!request.stresses.file.empty()) require_memory(request.stresses, request.scene);
  SolveSceneOptions options = grid_options(request);
  std::vector<solver::SolutionFields> cycle;
  if (request.stresses.fatigue.any()) keep_last_cycle(options, request.scene.cycles, cycle);
  SolvedScene solved = request.checkpoint.file.empty() ? solve_or_keep_steps(request.scene, options, result)
                                                       : solve_with_checkpoint(request, result);
  if (request.continuum)
    solved.record.end.certificate.continuum =
        continuum_record(request.scene, solved.solution, &solved.solution.gap_density);
  write_solved(request, solved, cycle, text, result);
  return std::move(solved.record);
}

SolveRecord answer_exactly(const SolveRequest& request, std::ostream& text, Json& result) {
  const auto start = std::chrono::steady_clock::now();
  const Oracle oracle = require_oracle(request.scene);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  SolveRecord record = exact_record(request.scene, oracle, seconds);
  result = to_json(record);
  text << solve_text(record, solver::Units(request.scene.units));
  report(request, record);
  write_files(request, result,
              [&](const auto& file) { write_exact_fields(file, request.scene, oracle, request.ranks); });
  return record;
}

/// Solves on meshes and to tolerances that reach the target.
int solve_to_target(const SolveRequest& request, std::ostream& text, Json& result) {
  const auto cache = std::make_shared<solver::SolveCache>();
  const AccurateAnswer found =
      solve_to_accuracy(request.scene, *request.target, [&](const solver::Scene& chosen, solver::Detail detail) {
        SolveSceneOptions options = grid_options(request);
        options.cache = cache;
        options.detail = detail;
        return solve_or_keep_steps(chosen, options, result);
      });
  result = to_json(found.answer.record);
  result["accuracy"] = to_json(found.accuracy);
  write_answer(request, found.answer, text, result);
  text << accuracy_text(found.accuracy);
  return found.reached() ? 0 : 1;
}

/// Solves on meshes until the interval of the continuous problem is narrow enough.
int solve_to_interval(SolveRequest request, std::ostream& text, Json& result) {
  const ProvenAnswer found = solve_until_proven(request.scene, *request.proven, [&](const solver::Scene& chosen) {
    return solve_or_keep_steps(chosen, grid_options(request), result);
  });
  request.scene = found.scene;
  write_solved(request, found.solved, {}, text, result);
  result["proven"] = found.account;
  text << found.text;
  return found.account.contains("not_reached") ? 1 : 0;
}

}  // namespace

bool has_step(const std::string& file) { return file.find(kStep) != std::string::npos; }

std::string file_of_step(std::string file, std::size_t step) {
  return file.replace(file.find(kStep), kStep.size(), std::to_string(step));
}

int run_request(const SolveRequest& request, std::ostream& text, Json& result) {
  if (request.plan) {
    SolvePlan plan = request.target ? accuracy_plan(request.scene, *request.target)
                                    : plan_solve(request.scene, request.planned_ranks);
    if (!request.stresses.file.empty()) {
      plan.stresses = plan_stresses(request.stresses, request.scene);
      for (double* const bytes : {&plan.bytes, &plan.least_bytes}) *bytes = std::max(plan.stresses->bytes, *bytes);
    }
    result["plan"] = to_json(plan);
    text << plan_text(plan);
    return 0;
  }
  const bool exact = request.scene.solver.model == solver::ModelChoice::exact;
  if (request.target && !exact) return solve_to_target(request, text, result);
  if (request.proven) return solve_to_interval(request, text, result);
  std::optional<Accuracy> accuracy;
  if (request.target) accuracy = exact_accuracy(request.scene, *request.target);
  const SolveRecord record = exact ? answer_exactly(request, text, result) : answer_on_grid(request, text, result);
  if (accuracy) {
    result["accuracy"] = to_json(*accuracy);
    text << accuracy_text(*accuracy);
  }
  if (!record.is_converged()) return 1;
  if (request.uncertain.empty()) return 0;
  const Uncertainty found = uncertainty_of(record, request.uncertain, request.source,
                                           {.ranks = request.ranks, .programs = allowed_programs()});
  result["uncertainty"] = to_json(found);
  text << uncertainty_text(found);
  return 0;
}

}  // namespace slipstick::convergence
