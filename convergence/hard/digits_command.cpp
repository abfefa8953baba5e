#include "convergence/commands.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "convergence/hard/rounding_digits.hpp"
#include "convergence/programs/output_options.hpp"
#include "convergence/runs/run_options.hpp"

namespace slipstick::convergence {
namespace {

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
