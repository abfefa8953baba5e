#include "convergence/solve_command.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "convergence/oracle.hpp"
#include "convergence/result.hpp"
#include "solver/field_file.hpp"
#include "solver/solve.hpp"

namespace slipstick::convergence {
namespace {

struct Options {
  std::string scene;
  std::vector<std::string> overrides;
  std::string fields;
};

/// One line on a terminal, rewritten; nothing elsewhere.
void show_progress(int iteration, double change) {
  if (isatty(STDERR_FILENO) != 0)
    fmt::print(stderr, "\r\033[Kiteration {}, change {:.1e}\r", iteration, change);
}

int run(const Options& options, std::ostream& text, Json& result) {
  if (!options.fields.empty()) solver::require_field_format(options.fields);
  const solver::Scene scene = solver::read_scene(options.scene, options.overrides);
  const OracleAnswer exact = find_oracle(scene);
  const solver::Solution solution = solver::solve(scene, {.progress = show_progress});
  result = solve_result(scene, solution, exact);
  if (!options.fields.empty()) write_solution_fields(options.fields, solution, exact);
  text << solve_text(result);
  return solution.status == solver::Status::converged ? 0 : 1;
}

}  // namespace

std::function<int(std::ostream&, nlohmann::ordered_json&)> add_solve_command(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand("solve", "Solve a scene numerically");
  command->add_option("scene", options->scene, "scene file (TOML)")->required();
  command
      ->add_option("--set", options->overrides,
                   "key=value: override a key of the scene, e.g. load.moment_ratio=0.5")
      ->take_all()
      ->allow_extra_args(false);
  command->add_option("--fields", options->fields,
                      "write tractions, pressure, slip and stick: .h5, .csv or .vti");
  command->footer(
      "Example:\n  slipstick solve convergence/scenes/paper.toml --set load.moment_ratio=0.5 --json "
      "result.json --fields "
      "fields.h5\nExit code 0: converged; 1: not, result written all the same; 2: bad input, or gross slip "
      "asked for.");
  return
      [options](std::ostream& text, nlohmann::ordered_json& result) { return run(*options, text, result); };
}

}  // namespace slipstick::convergence
