#include "convergence/solve_command.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "convergence/exact_result.hpp"
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
  std::string model;
};

/// One line on a terminal, rewritten; nothing elsewhere.
void show_progress(int iteration, double change) {
  if (isatty(STDERR_FILENO) != 0)
    fmt::print(stderr, "\r\033[Kiteration {}, change {:.1e}\r", iteration, change);
}

solver::Scene read_scene(const Options& options) {
  std::vector<std::string> overrides = options.overrides;
  if (!options.model.empty()) overrides.push_back(fmt::format("solver.model=\"{}\"", options.model));
  return solver::read_scene(options.scene, overrides);
}

int answer_exactly(const solver::Scene& scene, const std::string& fields, std::ostream& text, Json& result) {
  const auto start = std::chrono::steady_clock::now();
  const Oracle oracle = require_oracle(scene);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result = exact_result(scene, oracle, seconds);
  if (!fields.empty()) write_exact_fields(fields, scene, oracle);
  text << exact_text(result);
  return 0;
}

int solve_on_grid(const solver::Scene& scene, const std::string& fields, std::ostream& text, Json& result) {
  const OracleAnswer exact = find_oracle(scene);
  const solver::Solution solution = solver::solve(scene, {.progress = show_progress});
  result = solve_result(scene, solution, exact);
  if (!fields.empty()) write_solution_fields(fields, solution, exact);
  text << solve_text(result);
  return solution.status == solver::Status::converged ? 0 : 1;
}

int run(const Options& options, std::ostream& text, Json& result) {
  if (!options.fields.empty()) solver::require_field_format(options.fields);
  const solver::Scene scene = read_scene(options);
  const bool exact = scene.model == solver::ModelChoice::exact;
  return (exact ? answer_exactly : solve_on_grid)(scene, options.fields, text, result);
}

}  // namespace

std::function<int(std::ostream&, nlohmann::ordered_json&)> add_solve_command(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand("solve", "Solve a scene, on a grid or exactly");
  command->add_option("scene", options->scene, "scene file (TOML)")->required();
  command
      ->add_option("--set", options->overrides,
                   "key=value: override a key of the scene, e.g. load.moment_ratio=0.5")
      ->take_all()
      ->allow_extra_args(false);
  command->add_option(
      "--model", options->model,
      "auto (leaves out what the scene allows) | full | exact (no grid: the exact solution of an "
      "axisymmetric scene); as --set solver.model=...");
  command->add_option("--fields", options->fields,
                      "write tractions, pressure, stick and, from a grid, slip: .h5, .csv or .vti");
  command->footer(
      "Example:\n  slipstick solve convergence/scenes/paper.toml --set load.moment_ratio=0.5 --json "
      "result.json --fields "
      "fields.h5\n  slipstick solve convergence/scenes/cone.toml --model exact\nExit code 0: converged; 1: "
      "not, result written all the same; 2: bad input, or gross slip "
      "asked for, or --model exact where no exact answer is known.");
  return
      [options](std::ostream& text, nlohmann::ordered_json& result) { return run(*options, text, result); };
}

}  // namespace slipstick::convergence
