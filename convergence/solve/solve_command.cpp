#include "convergence/commands.hpp"

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "convergence/runs/run_options.hpp"
#include "convergence/solve/measured_accuracy.hpp"
#include "convergence/solve/solve_request.hpp"

namespace slipstick::convergence {
namespace {

/// Which model answers, how accurately, and what is said before or beside the answer.
void add_accuracy_options(CLI::App& command, SolveRequest& request) {
  command.add_option(
      "--model", request.model,
      "auto (leaves out what the scene allows) | full | exact (no grid: the exact solution of an "
      "axisymmetric scene); as --set solver.model=...");
  command.add_option(
      "--accuracy", request.accuracy,
      "relative error to reach, e.g. 1e-4: chooses cells, tolerance and, unless said, the model; "
      "says what was reached");
  std::vector<std::string> words;
  for (const auto& [word, of] : accuracy_words()) words.push_back(word);
  command
      .add_option("--accuracy-of", request.accuracy_of,
                  "what --accuracy is asked of; where the twist is imposed, twist means the moment")
      ->check(CLI::IsMember(words))
      ->capture_default_str();
  command
      .add_option("--uncertain", request.uncertain,
                  "key=P%: standard uncertainties of the scene's numbers, e.g. friction=5% "
                  "young_modulus=2%; says what they make of each output, beside the numerical error")
      ->excludes(command.get_option("--accuracy"));
  command.add_flag("--plan", request.plan, "predict memory and time of what would be solved, and stop")
      ->excludes(command.get_option("--uncertain"));
  command
      .add_option("--ranks", request.planned_ranks,
                  "with --plan: on so many ranks of MPI, of which the memory is that of one")
      ->needs(command.get_option("--plan"))
      ->excludes(command.get_option("--accuracy"))
      ->check(CLI::Range(1, 1'000'000));
}

/// Files that are written.
void add_file_options(CLI::App& command, SolveRequest& request) {
  command.add_option(
      "--fields", request.fields,
      "write tractions, pressure, stick and, from a grid, slip: .h5, .csv or .vti; of a history the "
      "last step, or each to a file of its own where the name holds {step}");
  command
      .add_option("--checkpoint", request.checkpoint,
                  "of a history: keep where it stands in this file (HDF5), after its first step and then as "
                  "often as that costs 1 % of the time")
      ->excludes(command.get_option("--accuracy"));
  command
      .add_flag("--resume", request.resume,
                "go on from the file that --checkpoint names, where it is there; the result is that of a "
                "history without a break")
      ->needs(command.get_option("--checkpoint"));
  command.add_option("--figure", request.figure,
                     "draw slip and stick, tractions and pressure: .svg, .pdf or .png");
}

}  // namespace

RunCommand add_solve_command(CLI::App& app, const solver::Ranks& ranks) {
  const auto request = std::make_shared<SolveRequest>();
  request->processes = ranks;
  CLI::App* const command = app.add_subcommand("solve", "Solve a scene, on a grid or exactly");
  command->add_option("scene", request->scene, "scene file (TOML)")->required();
  add_set_option(*command, request->overrides, "override a key of the scene, e.g. load.moment_ratio=0.5");
  add_program_options(*command, request->overrides, request->allow_programs);
  add_accuracy_options(*command, *request);
  add_file_options(*command, *request);
  add_memory_option(*command, request->memory_limit);
  constexpr const char* kHidden = "";
  command->add_option("--keep", request->keep, "folder that keeps the results of runs from standard input")
      ->group(kHidden);
  command->footer(
      "Example:\n  slipstick solve convergence/scenes/paper.toml --set load.moment_ratio=0.5 --json "
      "result.json --fields fields.h5 --figure figure.svg\n"
      "  slipstick solve convergence/scenes/cone.toml --model exact\n"
      "  slipstick solve convergence/scenes/ellipse.toml --accuracy 1e-3\n"
      "Exit code 0: converged; 1: not, or the accuracy not reached, result written all the same; 2: bad "
      "input, or gross slip asked for, or --model exact where no exact answer is known.");
  return running(command, request, run_solve);
}

}  // namespace slipstick::convergence
