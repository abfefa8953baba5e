#include "convergence/solve/solve_request.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <chrono>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "convergence/oracle/oracle.hpp"
#include "convergence/programs/python_script.hpp"
#include "convergence/programs/temporary_folder.hpp"
#include "convergence/results/exact_result.hpp"
#include "convergence/results/output.hpp"
#include "convergence/results/record_text.hpp"
#include "convergence/results/solution_fields.hpp"
#include "convergence/runs/run_spec.hpp"
#include "convergence/runs/solve_scene.hpp"
#include "convergence/runs/worker.hpp"
#include "convergence/solve/accurate_solve.hpp"
#include "convergence/solve/checkpoint.hpp"
#include "convergence/system/machine.hpp"
#include "solver/cache/solve_cache.hpp"
#include "solver/history/history_state.hpp"
#include "solver/input/input_error.hpp"
#include "solver/solve.hpp"

namespace slipstick::convergence {
namespace {

constexpr std::string_view kStep = "{step}";

/// Rewrites one line on a terminal; writes nothing to a file or pipe.
void show_progress(int iteration, double change) {
  if (isatty(STDERR_FILENO) != 0)
    std::cerr << fmt::format("\r\033[Kiteration {}, change {:.1e}\r", iteration, change);
}

/// Writes fields and figure on all ranks; write_fields writes the cells to a file. The last step's fields of
/// a history with one file a step were written at the end of that step.
template <typename WriteFields>
void write_files(const AnswerFiles& files, const solver::Ranks& ranks, const Json& result,
                 const WriteFields& write_fields) {
  if (!files.fields.empty() && !has_step(files.fields)) write_fields(files.fields);
  if (files.figure.empty()) return;
  if (!ranks.first()) return write_fields(files.figure + ".h5");  // its cells go to the first rank's file
  const TemporaryFolder folder;
  write_fields(folder / kFieldsFile);
  draw_solve(files.figure, result, folder);
}

void write_answer(const SolvedScene& answer, const AnswerFiles& files, const solver::Ranks& ranks,
                  std::ostream& text, const Json& result) {
  text << solve_text(answer.record);
  write_files(files, ranks, result,
              [&](const auto& file) { write_solution_fields(file, answer.solution, answer.exact); });
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

/// Options of a solve on a grid that writes the fields of each step if `files` names one file a step.
SolveSceneOptions grid_options(const AnswerFiles& files, const solver::Ranks& ranks,
                               std::size_t finished_steps = 0) {
  const auto write_step = [&files, step = finished_steps](const solver::Solution& at,
                                                          const OracleAnswer& exact) mutable {
    ++step;
    if (has_step(files.fields)) write_solution_fields(file_of_step(files.fields, step), at, exact);
  };
  return {.progress = ranks.first() ? show_progress : nullptr,
          .on_step = write_step,
          .ranks = ranks,
          .programs = allowed_programs()};
}

/// The steps that the checkpoint has; null: none. Throws InputError for a file that exists without --resume.
std::shared_ptr<const FinishedSteps> finished_steps(const Checkpoint& checkpoint, const CheckpointFile& given,
                                                    const solver::Ranks& ranks) {
  if (!given.resume && std::filesystem::exists(given.file)) {
    throw solver::InputError("--checkpoint " + given.file,
                             "exists already; allowed: --resume, to continue from it, or another file");
  }
  std::shared_ptr<const FinishedSteps> finished = checkpoint.read();
  if (finished && ranks.first()) {
    std::cerr << plain_text(
        fmt::format("slipstick: continues after step {}, from {}\n", finished->state->finished, given.file));
  }
  return finished;
}

/// Solves with a checkpoint after steps.
SolvedScene solve_with_checkpoint(const SolveOnGrid& request, const CheckpointFile& given, Json& result) {
  if (request.scene.solver.rounding_seed != 0) {
    throw solver::InputError(request.scene.source.string(), "solver.rounding_seed",
                             std::to_string(request.scene.solver.rounding_seed),
                             "left out with --checkpoint: rounding_seed cannot be resumed, its random stream "
                             "restarts");
  }
  const Checkpoint checkpoint(
      given.file, prepare_run({.scene = request.source.file, .overrides = request.source.overrides}));
  PacedCheckpoint paced(checkpoint);
  const auto resumed = finished_steps(checkpoint, given, request.ranks);
  SolveSceneOptions options =
      grid_options(request.files, request.ranks, resumed ? resumed->state->finished : 0);
  options.resumed = resumed;
  if (request.ranks.first()) {
    options.on_state = [&](const solver::HistoryState& state, const std::vector<StepRecord>& steps) {
      paced.offer(state, steps);
    };
  }
  return solve_or_keep_steps(request.scene, options, result);
}

}  // namespace

bool has_step(const std::string& file) { return file.find(kStep) != std::string::npos; }

std::string file_of_step(std::string file, std::size_t step) {
  return file.replace(file.find(kStep), kStep.size(), std::to_string(step));
}

int ServeRuns::run(std::ostream&, Json&) const { return serve_runs(folder, memory_limit); }

int PlanSolve::run(std::ostream& text, Json& result) const {
  const SolvePlan plan = plan_solve(scene, ranks);
  result["plan"] = to_json(plan);
  text << plan_text(plan);
  return 0;
}

int PlanAccuracy::run(std::ostream& text, Json& result) const {
  const SolvePlan plan = accuracy_plan(scene, target);
  result["plan"] = to_json(plan);
  text << plan_text(plan);
  return 0;
}

SolveRecord AnswerExactly::answer(std::ostream& text, Json& result) const {
  const auto start = std::chrono::steady_clock::now();
  const Oracle oracle = require_oracle(scene);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  SolveRecord record = exact_record(scene, oracle, seconds);
  result = to_json(record);
  text << solve_text(record);
  write_files(files, ranks, result,
              [&](const auto& file) { write_exact_fields(file, scene, oracle, ranks); });
  return record;
}

int AnswerExactly::run(std::ostream& text, Json& result) const {
  answer(text, result);
  return 0;
}

int AnswerExactlyTo::run(std::ostream& text, Json& result) const {
  const Accuracy accuracy = exact_accuracy(exact.scene, target);
  exact.run(text, result);
  result["accuracy"] = to_json(accuracy);
  text << accuracy_text(accuracy);
  return 0;
}

SolveRecord SolveOnGrid::answer(std::ostream& text, Json& result) const {
  SolvedScene solved = checkpoint ? solve_with_checkpoint(*this, *checkpoint, result)
                                  : solve_or_keep_steps(scene, grid_options(files, ranks), result);
  result = to_json(solved.record);
  write_answer(solved, files, ranks, text, result);
  return std::move(solved.record);
}

int SolveOnGrid::run(std::ostream& text, Json& result) const {
  return answer(text, result).is_converged() ? 0 : 1;
}

int SolveToAccuracy::run(std::ostream& text, Json& result) const {
  const auto cache = std::make_shared<solver::SolveCache>();
  const AccurateAnswer found =
      solve_to_accuracy(scene, target, [&](const solver::Scene& chosen, solver::Detail detail) {
        SolveSceneOptions options = grid_options(files, {});
        options.cache = cache;
        options.detail = detail;
        return solve_or_keep_steps(chosen, options, result);
      });
  result = to_json(found.answer.record);
  result["accuracy"] = to_json(found.accuracy);
  write_answer(found.answer, files, {}, text, result);
  text << accuracy_text(found.accuracy);
  return found.reached() ? 0 : 1;
}

int SolveWithUncertainty::run(std::ostream& text, Json& result) const {
  const SolveRecord record = std::visit([&](const auto& way) { return way.answer(text, result); }, solve);
  if (!record.is_converged()) return 1;
  const solver::Ranks ranks = std::visit([](const auto& way) { return way.ranks; }, solve);
  const Uncertainty found =
      uncertainty_of(record, inputs, source, {.ranks = ranks, .programs = allowed_programs()});
  result["uncertainty"] = to_json(found);
  text << uncertainty_text(found);
  return 0;
}

}  // namespace slipstick::convergence
