#include "convergence/check/check_command.hpp"

#include <fmt/core.h>

#include <cmath>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "convergence/check/check.hpp"
#include "solver/input_error.hpp"
#include "solver/scene.hpp"

namespace slipstick::convergence {
namespace {

struct Options {
  std::string scene;
  std::string field;
  std::vector<std::string> overrides;
  std::optional<double> twist;
};

int run(const Options& options, std::ostream& text, Json& result) {
  if (options.twist && !std::isfinite(*options.twist)) {
    throw solver::InputError(fmt::format("--twist {}", *options.twist), "allowed: a finite number, in rad");
  }
  result = check_field(solver::read_scene(options.scene, options.overrides), options.field, options.twist);
  text << check_text(result);
  return result["verdict"] == "good" ? 0 : 1;
}

}  // namespace

std::function<int(std::ostream&, nlohmann::ordered_json&)> add_check_command(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand("check", "Judge a traction field that any program computed");
  command->add_option("scene", options->scene, "scene file (TOML) that the program solved")->required();
  command
      ->add_option("field", options->field,
                   "columns x1, x2 (m), pressure, q1, q2 (Pa), one row for each contact cell: .csv or .h5")
      ->required();
  command
      ->add_option("--set", options->overrides,
                   "key=value: override a key of the scene, e.g. load.moment_ratio=0.5")
      ->take_all()
      ->allow_extra_args(false);
  command->add_option("--twist", options->twist,
                      "rad, that the program reported; without it the one that Coulomb's law fits best");
  command->footer(
      "Example:\n  slipstick check convergence/scenes/paper.toml tractions.csv --twist 2.361e-3\nExit code "
      "0: "
      "good; 1: bad; 2: cannot be judged. docs/verify-your-solver.md explains each number.");
  return
      [options](std::ostream& text, nlohmann::ordered_json& result) { return run(*options, text, result); };
}

}  // namespace slipstick::convergence
