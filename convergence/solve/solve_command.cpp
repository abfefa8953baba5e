#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "convergence/commands.hpp"
#include "convergence/programs/output_options.hpp"
#include "convergence/programs/python_script.hpp"
#include "convergence/programs/temporary_folder.hpp"
#include "convergence/results/output.hpp"
#include "convergence/runs/run_options.hpp"
#include "convergence/runs/run_spec.hpp"
#include "convergence/runs/worker.hpp"
#include "convergence/solve/measured_accuracy.hpp"
#include "convergence/solve/solve_request.hpp"
#include "solver/input/field_file.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/toml_reader.hpp"

namespace slipstick::convergence {
namespace {

using solver::InputError;
using solver::Scene;

/// The options as the command line gives them, and the request that they make.
struct SolveWords {
  SolveRequest request;
  bool allow_programs = false;
  std::string model;               ///< word of solver.model; empty: the scene's
  std::optional<double> accuracy;  ///< relative error to reach
  std::string accuracy_of = "twist";
  std::vector<std::string> uncertain;  ///< "key=P%"
  std::string keep;                    ///< folder for the results of a pool's worker; empty: none
};

void add_accuracy_options(CLI::App& command, SolveWords& words) {
  command.add_option("--model", words.model,
                     "auto (leaves out what the scene allows) | full | exact (no grid: the exact solution of an "
                     "axisymmetric scene); as --set solver.model=...");
  command.add_option("--accuracy", words.accuracy,
                     "relative error to reach, e.g. 1e-4: chooses cells, tolerance and, unless "
                     "solver.model is given, the model; the result has the error that was reached");
  std::vector<std::string> quantities;
  for (const auto& [word, of] : accuracy_words()) quantities.push_back(word);
  command
      .add_option("--accuracy-of", words.accuracy_of,
                  "quantity whose error --accuracy bounds; where the twist is imposed, twist means the moment")
      ->check(CLI::IsMember(quantities))
      ->capture_default_str();
  command
      .add_option("--uncertain", words.uncertain,
                  "key=P%: standard uncertainties of the scene's numbers, e.g. friction=5% "
                  "young_modulus=2%; the result has the uncertainty of each output and its numerical error")
      ->excludes(command.get_option("--accuracy"));
  command.add_flag("--plan", words.request.plan, "predict memory and time of the solve, and stop")
      ->excludes(command.get_option("--uncertain"));
  command
      .add_flag("--continuum", words.request.continuum,
                "bound the distance from the law of friction in all of the contact, not only at the cells' "
                "centres, and the number that the loads leave open: certificate.continuum")
      ->excludes(command.get_option("--plan"))
      ->excludes(command.get_option("--accuracy"));
  CLI::Option* const proven =
      command
          .add_option("--proven", words.request.proven,
                      "take more cells until the interval of --continuum is this narrow, relative to the "
                      "number in it, e.g. 1e-2")
          ->check(CLI::Range(1e-6, 1.0));
  for (const char* const option : {"--plan", "--accuracy", "--uncertain"}) proven->excludes(command.get_option(option));
  command
      .add_option("--ranks", words.request.planned_ranks,
                  "with --plan: number of MPI ranks that share the solve; the memory is that of one rank")
      ->needs(command.get_option("--plan"))
      ->excludes(command.get_option("--accuracy"))
      ->check(CLI::Range(1, 1'000'000));
}

void add_file_options(CLI::App& command, SolveWords& words) {
  command.add_option("--fields", words.request.files.fields,
                     "write tractions, pressure, stick and, from a grid, slip: .h5, .csv or .vti; of a history the "
                     "last step, or each step to its own file where the name holds {step}");
  command
      .add_option("--checkpoint", words.request.checkpoint.file,
                  "write checkpoints of a load history to this HDF5 file, after the first step and then as "
                  "often as takes 1 % of the time")
      ->excludes(command.get_option("--accuracy"))
      ->excludes(command.get_option("--proven"));
  command
      .add_flag("--resume", words.request.checkpoint.resume,
                "continue from the --checkpoint file if it exists; the result is the same as without a break")
      ->needs(command.get_option("--checkpoint"));
  command.add_option("--figure", words.request.files.figure,
                     "draw slip and stick, tractions and pressure, and of a history its loop: .svg, .pdf or .png; "
                     "of the last step, or of each step where the name holds {step}");
  command.add_option("--loop", words.request.files.loop,
                     "write loads, motions and energies at the end of each step of a history, a row a step: .csv");
}

void add_stress_options(CLI::App& command, StressFiles& stresses) {
  CLI::Option* const depths =
      command
          .add_option("--depths", stresses.depth_words,
                      "depths below the surface, in m, with a unit or over a Hertzian contact's radius: "
                      "20um,\"0.1 mm\",0.5a; 0.02a..2a:32 are 32 depths with equal ratios")
          ->delimiter(',');
  CLI::Option* const file = command.add_option(
      "--stresses", stresses.file,
      "write the stresses below the surface at --depths, of a history after the last step: .vtr, one volume "
      "for ParaView; or .h5, .csv or .vti, of several depths each to its own file, where the name holds "
      "{depth}; of both bodies where it holds {body}");
  file->needs(depths);
  depths->needs(file);
  command
      .add_option("--stress-figure", stresses.figure,
                  "draw von Mises' and the largest shear stress of the volume in the planes through the largest one: "
                  ".svg, .pdf or .png; of both bodies where it holds {body}")
      ->needs(file);
  const auto add_coefficient = [&](const char* name, std::optional<double>& coefficient, const char* help) {
    command.add_option(name, coefficient, help)
        ->check(CLI::NonNegativeNumber)
        ->needs(file)
        ->excludes(command.get_option("--checkpoint"));
  };
  add_coefficient("--dang-van", stresses.fatigue.dang_van,
                  "alpha: the largest shear amplitude + alpha times hydrostatic stress over the last cycle");
  add_coefficient("--findley", stresses.fatigue.findley,
                  "k: the largest shear amplitude + k times largest normal stress of a plane over the last "
                  "cycle");
  for (const char* const option : {"--accuracy", "--ranks"}) file->excludes(command.get_option(option));
}

void require_file_formats(const AnswerFiles& files) {
  if (!files.fields.empty()) solver::require_field_format(files.fields);
  if (!files.figure.empty()) require_figure_format(files.figure);
  if (!files.loop.empty() && !files.loop.ends_with(".csv"))
    throw InputError("--loop " + files.loop, "allowed ending: .csv");
}

/// Throws InputError where the cells of all steps cannot be had.
void require_cells_of_steps(const SolveRequest& request) {
  const bool exact = request.scene.solver.model == solver::ModelChoice::exact;
  if (!exact && request.checkpoint.file.empty()) return;
  throw InputError("--figure " + request.files.figure,
                   exact ? "allowed: a name without {step}: an exact solution has the cells of the last step"
                         : "allowed: a name without {step}: with --checkpoint the steps before a break are not "
                           "drawn (--fields takes {step})");
}

/// Throws InputError where a file of the scene would be overwritten.
void require_scene_kept(const CLI::App& command, const std::string& fields, const Scene& scene) {
  const std::vector<std::filesystem::path> inputs = input_files(scene);
  require_inputs_kept(command, inputs);
  if (!has_step(fields)) return;
  const std::size_t steps = scene.steps.size() * static_cast<std::size_t>(scene.cycles);
  for (std::size_t step = 1; step <= steps; ++step) {
    require_input_kept("--fields", file_of_step(fields, step), inputs);
  }
}

/// Throws InputError for options that several ranks cannot share.
void require_shared_by_ranks(const SolveWords& words, const Scene& scene) {
  if (words.accuracy) {
    throw InputError("--accuracy", "not on several ranks; allowed: cells that the scene names");
  }
  if (!words.request.stresses.file.empty()) {
    throw InputError("--stresses", "not on several ranks; allowed: one rank");
  }
  if (scene.solver.rounding_seed != 0) {
    throw InputError("solver.rounding_seed", "not on several ranks; allowed: 0");
  }
  if (scene.solver.op != solver::OperatorKind::dcfft) {
    throw InputError("solver.operator", "not on several ranks; allowed there: \"dcfft\"");
  }
}

/// Throws InputError where the scene's program may not run, and for options that no other program takes.
void require_for_programs(const SolveWords& words) {
  const auto& [request, allow_programs, model, accuracy, accuracy_of, uncertain, keep] = words;
  require_allowed(request.scene, {allow_programs, request.source.overrides});
  const bool exact = request.scene.solver.model == solver::ModelChoice::exact;
  const char* const option = accuracy                           ? "--accuracy"
                             : request.plan                     ? "--plan"
                             : !request.checkpoint.file.empty() ? "--checkpoint"
                             : request.ranks.several()          ? "several ranks"
                             : exact                            ? "solver.model = \"exact\""
                                                                : nullptr;
  if (option == nullptr) return;
  throw InputError(option, "cannot be combined with solver.program; allowed: without it");
}

/// Throws InputError for keys that --accuracy chooses.
void require_not_set(const std::vector<std::string>& overrides) {
  for (const std::string& assignment : overrides) {
    for (const std::string_view key : {"grid.cells", "solver.tolerance"}) {
      if (!assignment.starts_with(key)) continue;
      throw InputError(fmt::format("--set {}", assignment),
                       "cannot be combined with --accuracy, which chooses the cells and the tolerance");
    }
  }
}

/// The target of --accuracy. The exact model is taken where it answers, unless the user chooses a model.
void set_target(const SolveWords& words, SolveRequest& request) {
  AccuracyTarget target{.error = *words.accuracy};
  for (const auto& [word, of] : accuracy_words()) {
    if (word == words.accuracy_of) target.of = of;
  }
  require_not_set(request.source.overrides);
  const bool chosen = solver::SceneReader(request.source.file, request.source.overrides).has("solver.model");
  if (!chosen && answers_exactly(request.scene, target.of)) {
    request.scene.solver.model = solver::ModelChoice::exact;
  }
  require_reachable(request.scene, target);
  request.target = target;
}

/// Throws InputError for invalid combinations of options and scene.
SolveRequest request_of(const CLI::App& command, SolveWords words) {
  SolveRequest& request = words.request;
  require_file_formats(request.files);
  if (!request.stresses.figure.empty()) require_figure_format(request.stresses.figure, "--stress-figure");
  if (!words.model.empty()) {
    request.source.overrides.push_back(fmt::format("solver.model=\"{}\"", words.model));
  }
  request.scene = request.source.read();
  if (!request.scene.solver.program.empty()) require_for_programs(words);
  if (request.ranks.several()) require_shared_by_ranks(words, request.scene);
  if (!request.stresses.file.empty()) request.stresses.read_depths(request.scene);
  require_scene_kept(command, request.files.fields, request.scene);
  require_output("--fields", request.files.fields);
  for (std::size_t d = 0; d < request.stresses.depths.size(); ++d) {
    for (const solver::Body body : request.stresses.bodies(request.scene)) {
      const std::string file = request.stresses.name(d, body);
      require_input_kept("--stresses", file, input_files(request.scene));
      require_output("--stresses", file);
      if (std::filesystem::path(file).lexically_normal() ==
          std::filesystem::path(request.files.fields).lexically_normal())
        throw InputError("--stresses " + file, "is the file of --fields too; allowed: another name");
    }
  }
  require_output("--loop", request.files.loop);
  require_output("--checkpoint", request.checkpoint.file);
  if (words.accuracy) set_target(words, request);
  if (has_step(request.files.figure)) {
    require_cells_of_steps(request);
    request.files.cells_of_steps = std::make_shared<TemporaryFolder>();
  }
  if (!words.uncertain.empty()) request.uncertain = uncertain_inputs(request.source, words.uncertain);
  return std::move(request);
}

int run_solve(const CLI::App& command, const SolveWords& words, std::ostream& text, Json& result) {
  if (!words.keep.empty()) return serve_runs(words.keep, words.request.source.memory_limit);
  return run_request(request_of(command, words), text, result);
}

}  // namespace

RunCommand add_solve_command(CLI::App& app, const solver::Ranks& ranks) {
  const auto words = std::make_shared<SolveWords>();
  words->request.ranks = ranks;
  CLI::App* const command = app.add_subcommand("solve", "Solve a scene, on a grid or exactly");
  command->add_option("scene", words->request.source.file, "scene file (TOML)")->required();
  add_set_option(*command, words->request.source.overrides, "override a key of the scene, e.g. load.moment_ratio=0.5");
  add_program_options(*command, words->request.source.overrides, words->allow_programs);
  add_accuracy_options(*command, *words);
  add_file_options(*command, *words);
  add_stress_options(*command, words->request.stresses);
  add_memory_option(*command, words->request.source.memory_limit);
  constexpr const char* kHidden = "";
  command->add_option("--keep", words->keep, "folder that keeps the results of runs from standard input")
      ->group(kHidden);
  command->footer(
      "Example:\n  slipstick solve convergence/scenes/paper.toml --set load.moment_ratio=0.5 --json "
      "result.json --fields fields.h5 --figure figure.svg\n"
      "  slipstick solve convergence/scenes/cone.toml --model exact\n"
      "  slipstick solve convergence/scenes/ellipse.toml --accuracy 1e-3\n"
      "Exit code 0: converged; 1: not converged, or accuracy not reached; the result is written; 2: bad "
      "input, a load beyond gross slip, or --model exact where no exact answer is known.");
  return running(command, words, run_solve);
}

}  // namespace slipstick::convergence
