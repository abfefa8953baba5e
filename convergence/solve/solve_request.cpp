#include "convergence/solve/solve_request.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <iostream>

#include "convergence/oracle/oracle.hpp"
#include "convergence/programs/output_options.hpp"
#include "convergence/programs/python_script.hpp"
#include "convergence/results/exact_result.hpp"
#include "convergence/results/output.hpp"
#include "convergence/results/record_text.hpp"
#include "convergence/results/solution_fields.hpp"
#include "convergence/runs/run_spec.hpp"
#include "convergence/runs/solve_scene.hpp"
#include "convergence/runs/worker.hpp"
#include "convergence/solve/accurate_solve.hpp"
#include "convergence/solve/checkpoint.hpp"
#include "convergence/solve/uncertainty.hpp"
#include "convergence/system/machine.hpp"
#include "solver/cache/solve_cache.hpp"
#include "solver/history/history_state.hpp"
#include "solver/input/field_file.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/toml_reader.hpp"
#include "solver/solve.hpp"

namespace slipstick::convergence {
namespace {

/// One line on a terminal, rewritten; nothing elsewhere.
void show_progress(int iteration, double change) {
  if (isatty(STDERR_FILENO) != 0)
    std::cerr << fmt::format("\r\033[Kiteration {}, change {:.1e}\r", iteration, change);
}

std::vector<std::string> overrides_of(const SolveRequest& request) {
  std::vector<std::string> overrides = request.overrides;
  if (!request.model.empty()) overrides.push_back(fmt::format("solver.model=\"{}\"", request.model));
  return overrides;
}

solver::Scene read_scene(const SolveRequest& request) {
  solver::Scene scene = solver::read_scene(request.scene, overrides_of(request));
  scene.solver.memory_limit = request.memory_limit;
  return scene;
}

/// Stands for the number of the step in the name of a file that is written for each step of a history.
constexpr std::string_view kStep = "{step}";

bool one_file_a_step(const std::string& file) { return file.find(kStep) != std::string::npos; }

std::string file_of_step(std::string file, std::size_t step) {
  return file.replace(file.find(kStep), kStep.size(), std::to_string(step));
}

/// The files asked for beside the result, by all ranks; write_fields writes the cells to the file it is
/// given.
void write_files(const SolveRequest& request, const Json& result,
                 const std::function<void(const std::filesystem::path&)>& write_fields) {
  if (!request.fields.empty() && !one_file_a_step(request.fields)) write_fields(request.fields);
  if (request.figure.empty()) return;
  // Other ranks have their cells to write, into the first one's file.
  request.processes.first() ? draw_solve(request.figure, result, write_fields)
                            : write_fields(request.figure + ".h5");
}

int answer_exactly(const solver::Scene& scene, const SolveRequest& request, std::ostream& text,
                   Json& result) {
  const auto start = std::chrono::steady_clock::now();
  const Oracle oracle = require_oracle(scene);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const SolveRecord record = exact_record(scene, oracle, seconds);
  result = to_json(record);
  text << solve_text(record);
  write_files(request, result,
              [&](const auto& file) { write_exact_fields(file, scene, oracle, request.processes); });
  return 0;
}

/// Where the history stands in the checkpoint to go on from; null: at its first step. Throws
/// InputError for a file that is there without --resume.
std::shared_ptr<const FinishedSteps> finished_in(const Checkpoint& checkpoint, const SolveRequest& request) {
  if (!request.resume && std::filesystem::exists(checkpoint.file())) {
    throw solver::InputError("--checkpoint " + request.checkpoint,
                             "is there already; allowed: --resume, to go on from it, or another file");
  }
  std::shared_ptr<const FinishedSteps> finished = checkpoint.read();
  if (finished && request.processes.first()) {
    std::cerr << plain_text(fmt::format("slipstick: goes on after step {}, from {}\n",
                                        finished->state->finished, request.checkpoint));
  }
  return finished;
}

/// Solves a history that leaves checkpoints.
SolvedScene solve_on(const solver::Scene& scene, const SolveRequest& request, SolveSceneOptions options,
                     std::size_t& step) {
  if (request.checkpoint.empty()) return solve_scene(scene, options);
  if (scene.solver.rounding_seed != 0) {
    throw solver::InputError(scene.source.string(), "solver.rounding_seed",
                             std::to_string(scene.solver.rounding_seed),
                             "left out beside --checkpoint: what is drawn after a break is drawn anew");
  }
  const Checkpoint checkpoint(request.checkpoint,
                              prepare_run({.scene = request.scene, .overrides = overrides_of(request)}));
  PacedCheckpoint paced(checkpoint);
  options.resumed = finished_in(checkpoint, request);
  if (options.resumed) step = options.resumed->state->finished;
  if (request.processes.first()) {
    options.on_state = [&](const solver::HistoryState& state, const std::vector<StepRecord>& steps) {
      paced.offer(state, steps);
    };
  }
  return solve_scene(scene, options);
}

/// Those that the scene may name: it has been asked whether its own may run.
AllowedPrograms allowed_programs() { return {.all = true, .tied_by = own_program()}; }

/// Solves, and writes the fields of each step where they go to a file of its own.
/// cache: null, or what several grids share.
SolvedScene find_on_grid(const solver::Scene& scene, const SolveRequest& request, Json& result,
                         const std::shared_ptr<solver::SolveCache>& cache = {},
                         solver::Detail detail = solver::Detail::all) {
  std::size_t step = 0;
  SolveRecord incomplete;
  const auto on_step = [&](const solver::Solution& at, const OracleAnswer& exact) {
    ++step;
    if (!one_file_a_step(request.fields)) return;
    write_solution_fields(file_of_step(request.fields, step), at, exact);
  };
  try {
    return solve_on(scene, request,
                    {.progress = request.processes.first() ? show_progress : nullptr,
                     .on_step = on_step,
                     .incomplete = &incomplete,
                     .cache = cache,
                     .detail = detail,
                     .ranks = request.processes,
                     .programs = allowed_programs()},
                    step);
  } catch (const solver::InputError&) {
    if (incomplete.history) result = to_json(incomplete);
    throw;
  }
}

void write_answer(const SolvedScene& answer, const SolveRequest& request, std::ostream& text) {
  text << solve_text(answer.record);
  write_files(request, to_json(answer.record),
              [&](const auto& file) { write_solution_fields(file, answer.solution, answer.exact); });
}

int solve_on_grid(const solver::Scene& scene, const SolveRequest& request, std::ostream& text, Json& result) {
  const SolvedScene answer = find_on_grid(scene, request, result);
  result = to_json(answer.record);
  write_answer(answer, request, text);
  return answer.solution.status == solver::Status::converged ? 0 : 1;
}

AccuracyTarget target_of(const SolveRequest& request) {
  AccuracyTarget target{.error = *request.accuracy};
  for (const auto& [word, of] : accuracy_words()) {
    if (word == request.accuracy_of) target.of = of;
  }
  return target;
}

/// The accuracy chooses these: both cannot hold.
void require_not_set(const std::vector<std::string>& overrides) {
  for (const std::string& assignment : overrides) {
    for (const std::string_view key : {"grid.cells", "solver.tolerance"}) {
      if (!assignment.starts_with(key)) continue;
      throw solver::InputError(
          fmt::format("--set {}", assignment),
          "allowed: left out beside --accuracy, which chooses the cells and the tolerance");
    }
  }
}

/// The exact side, where it answers and the user does not say otherwise.
solver::Scene model_chosen(solver::Scene scene, const SolveRequest& request, AccuracyOf of) {
  const bool said =
      !request.model.empty() || solver::SceneReader(request.scene, request.overrides).has("solver.model");
  if (!said && answers_exactly(scene, of)) scene.solver.model = solver::ModelChoice::exact;
  return scene;
}

int solve_accurately(solver::Scene scene, const SolveRequest& request, std::ostream& text, Json& result) {
  const AccuracyTarget target = target_of(request);
  require_not_set(request.overrides);
  scene = model_chosen(std::move(scene), request, target.of);
  require_reachable(scene, target);
  if (request.plan) {
    result["plan"] = accuracy_plan(scene, target);
    text << plan_text(result);
    return 0;
  }
  if (scene.solver.model == solver::ModelChoice::exact) {
    const Json accuracy = exact_accuracy(scene, target);
    answer_exactly(scene, request, text, result);
    result["accuracy"] = accuracy;
    text << accuracy_text(result);
    return 0;
  }
  const auto cache = std::make_shared<solver::SolveCache>();
  const AccurateAnswer answer =
      solve_to_accuracy(scene, target, [&](const solver::Scene& chosen, solver::Detail detail) {
        return find_on_grid(chosen, request, result, cache, detail);
      });
  result = to_json(answer.answer.record);
  result["accuracy"] = answer.accuracy;
  write_answer(answer.answer, request, text);
  text << accuracy_text(result);
  return answer.reached ? 0 : 1;
}

void add_uncertainty(const std::vector<UncertainInput>& uncertain, const SolveRequest& request,
                     std::ostream& text, Json& result) {
  const auto cache = std::make_shared<solver::SolveCache>();
  result["uncertainty"] = uncertainty_json(result, uncertain, [&](const std::vector<std::string>& changed) {
    std::vector<std::string> overrides = overrides_of(request);
    overrides.insert(overrides.end(), changed.begin(), changed.end());
    solver::Scene scene = solver::read_scene(request.scene, overrides);
    scene.solver.memory_limit = request.memory_limit;
    if (scene.solver.model == solver::ModelChoice::exact) {
      return to_json(exact_record(scene, require_oracle(scene), 0));
    }
    return to_json(
        solve_scene(scene, {.cache = cache, .ranks = request.processes, .programs = allowed_programs()})
            .record);
  });
  text << uncertainty_text(result);
}

/// No file of the scene is overwritten, by fields of a step either.
void require_scene_kept(const CLI::App& command, const SolveRequest& request, const solver::Scene& scene) {
  const std::vector<std::filesystem::path> inputs = input_files(scene);
  require_inputs_kept(command, inputs);
  if (!one_file_a_step(request.fields)) return;
  const std::size_t steps = scene.steps.size() * static_cast<std::size_t>(scene.cycles);
  for (std::size_t step = 1; step <= steps; ++step) {
    require_input_kept("--fields", file_of_step(request.fields, step), inputs);
  }
}

/// Throws InputError for what several ranks cannot share.
void require_shared_by_ranks(const SolveRequest& request, const solver::Scene& scene) {
  if (request.accuracy) {
    throw solver::InputError("--accuracy", "not on several ranks; allowed: cells that the scene names");
  }
  if (scene.solver.rounding_seed != 0) {
    throw solver::InputError("solver.rounding_seed", "not on several ranks; allowed: 0");
  }
  if (scene.solver.op != solver::OperatorKind::dcfft) {
    throw solver::InputError("solver.operator", "not on several ranks; allowed there: \"dcfft\"");
  }
}

/// Throws InputError where the scene's program may not run, and for what no other program can be asked.
void require_for_programs(const SolveRequest& request, const solver::Scene& scene) {
  require_allowed(scene, {request.allow_programs, request.overrides});
  const char* const what = request.accuracy                                   ? "--accuracy"
                           : request.plan                                     ? "--plan"
                           : !request.checkpoint.empty()                      ? "--checkpoint"
                           : request.processes.several()                      ? "several ranks"
                           : scene.solver.model != solver::ModelChoice::exact ? nullptr
                                                                              : "solver.model = \"exact\"";
  if (what == nullptr) return;
  throw solver::InputError(what, "not beside solver.program; allowed: without it");
}

}  // namespace

int run_solve(const CLI::App& command, const SolveRequest& request, std::ostream& text, Json& result) {
  if (!request.keep.empty()) return serve_runs(request.keep, request.memory_limit);
  if (!request.fields.empty()) solver::require_field_format(request.fields);
  if (!request.figure.empty()) require_figure_format(request.figure);
  if (one_file_a_step(request.figure)) {
    throw solver::InputError("--figure " + request.figure,
                             "allowed: a name without {step}: the figure is that of the last step (--fields "
                             "takes {step})");
  }
  const solver::Scene scene = read_scene(request);
  if (!scene.solver.program.empty()) require_for_programs(request, scene);
  if (request.processes.several()) require_shared_by_ranks(request, scene);
  require_scene_kept(command, request, scene);
  require_output("--fields", request.fields);
  require_output("--checkpoint", request.checkpoint);
  if (request.accuracy) return solve_accurately(scene, request, text, result);
  if (request.plan) {
    result["plan"] = plan_json(scene, request.planned_ranks);
    text << plan_text(result);
    return 0;
  }
  const std::vector<UncertainInput> uncertain =
      uncertain_inputs(request.scene, request.overrides, request.uncertain);
  const bool exact = scene.solver.model == solver::ModelChoice::exact;
  const int code = (exact ? answer_exactly : solve_on_grid)(scene, request, text, result);
  if (!uncertain.empty() && code == 0) add_uncertainty(uncertain, request, text, result);
  return code;
}

}  // namespace slipstick::convergence
