#include "convergence/commands.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "convergence/hard/hard_run.hpp"
#include "convergence/hard/rounding_digits.hpp"
#include "convergence/programs/output_options.hpp"
#include "convergence/runs/run_options.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/whole_file.hpp"

namespace slipstick::convergence {
namespace {

struct HardRequest {
  std::vector<std::string> files;
  std::string fields;
  std::vector<std::string> methods;
  bool once = false;
  RunOptions runs{.output = "build/hard"};
};

/// The fields' files are numbered: none of a scene's stands among them.
void require_inputs_elsewhere(const CLI::App& command, const std::vector<HardCase>& cases,
                              const std::filesystem::path& fields) {
  for (const HardCase& made : cases) {
    std::vector<std::filesystem::path> inputs;
    try {
      inputs = input_files(solver::read_scene(made.run.scene, made.run.overrides));
    } catch (const solver::InputError&) {  // the case will be refused
    }
    require_inputs_kept(command, inputs);
    for (const std::filesystem::path& input : inputs) {
      if (!fields.empty()) require_input_kept("--fields", fields / input.filename(), {input});
    }
  }
}

int run_hard(const CLI::App& command, const HardRequest& request, std::ostream& text, Json& result) {
  std::vector<HardCase> cases;
  for (const std::string& file : request.files) {
    for (HardCase& made : read_hard_cases(file)) {
      made.run = changed(std::move(made.run), request.runs.overrides);
      cases.push_back(std::move(made));
    }
  }
  require_inputs_elsewhere(command, cases, request.fields);
  if (!request.fields.empty()) solver::make_folder(request.fields);
  std::vector<BesideMethod> methods;
  RunOptions runs = request.runs;
  for (const std::string& word : request.methods) {
    methods.push_back(read_beside_method(word));
    runs.overrides.push_back(methods.back().override);  // named on the command line, it may run
  }
  const HardOptions options{
      .variants = !request.once, .finer_meshes = !request.once, .methods = methods, .fields = request.fields};
  if (request.runs.list.empty()) *runs.progress = Progress(hard_stages(options));
  std::vector<PreparedRun> lacking;
  const ProcessPool pool = runs.pool(&lacking);
  HardResult found;
  {
    const Interrupts interrupts;
    found = run_hard_cases(cases, options, pool);
    pool.progress().end();
  }
  if (!request.runs.list.empty()) return runs.write_list(lacking, text, result);
  result = to_json(found);
  text << hard_text(found);
  return found.count(HardVerdict::wrong) + found.count(HardVerdict::not_converged) == 0 ? 0 : 1;
}

struct DigitsRequest {
  RunSpec spec;
  DigitsOptions options;
  RunOptions runs{.output = "build/digits"};
};

int run_digits(const CLI::App& command, const DigitsRequest& request, std::ostream& text, Json& result) {
  require_inputs_kept(command, input_files(solver::read_scene(request.spec.scene, request.spec.overrides)));
  const ProcessPool pool = request.runs.pool();
  DigitsResult found;
  {
    const Interrupts interrupts;
    found = rounding_digits(request.spec, request.options, pool);
  }
  result = to_json(found);
  text << digits_text(found);
  return found.status == RunStatus::converged && found.not_converged == 0 ? 0 : 1;
}

}  // namespace

RunCommand add_hard_command(CLI::App& app) {
  const auto request = std::make_shared<HardRequest>();
  CLI::App* const command =
      app.add_subcommand("hard", "Solve hard scenes by the hundred, each in several views; judge each answer");
  command->add_option("files", request->files, "files of families of scenes (TOML)")->required();
  add_set_option(*command, request->runs.overrides, "override a key of all scenes");
  command->add_option("--fields", request->fields, "folder that gets the fields of each case (CSV)");
  command->add_flag("--once", request->once, "solve each scene once: no equivalent scenes, no finer meshes");
  command
      ->add_option("--beside", request->methods,
                   "methods, or files of programs (TOML), that solve each scene too, to be compared")
      ->delimiter(',');
  request->runs.add_to(*command);
  request->runs.add_programs_to(*command);
  request->runs.add_list_to(*command, {});
  command->footer(
      "Example:\n  slipstick hard convergence/hard/*.toml --json hard.json\nFinished solves are kept: "
      "repeating an interrupted command goes on from there.\nExit code 0: every answer is certified or "
      "refused with a reason; 1: some did not converge or are wrong, and are named; 2: bad input.");
  return running(command, request, run_hard);
}

RunCommand add_digits_command(CLI::App& app) {
  const auto request = std::make_shared<DigitsRequest>();
  CLI::App* const command =
      app.add_subcommand("digits", "Count the digits of an answer that do not depend on rounding");
  command->add_option("scene", request->spec.scene, "scene file (TOML)")->required();
  add_set_option(*command, request->spec.overrides, "override a key of the scene");
  command->add_option("--samples", request->options.samples, "solves that are rounded at random")
      ->capture_default_str()
      ->check(CLI::Range(1, 10'000));
  command->add_option("--seed", request->options.first_seed, "of the first of them")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  request->runs.add_to(*command);
  command->footer(
      "Example:\n  slipstick digits convergence/scenes/paper.toml --set grid.cells=[64,64]\nExit code 0: "
      "done; 1: a solve did not converge; 2: bad input.");
  return running(command, request, run_digits);
}

}  // namespace slipstick::convergence
