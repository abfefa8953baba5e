#include "convergence/solve_command.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "convergence/exact_result.hpp"
#include "convergence/oracle.hpp"
#include "convergence/result.hpp"
#include "convergence/solve_figure.hpp"
#include "solver/field_file.hpp"
#include "solver/input_error.hpp"
#include "solver/solve.hpp"

namespace slipstick::convergence {
namespace {

struct Options {
  std::string scene;
  std::vector<std::string> overrides;
  std::string fields;
  std::string figure;
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

/// Stands for the number of the step in the name of a file that is written for each step of a history.
constexpr std::string_view kStep = "{step}";

bool one_file_a_step(const std::string& file) { return file.find(kStep) != std::string::npos; }

std::string file_of_step(std::string file, std::size_t step) {
  return file.replace(file.find(kStep), kStep.size(), std::to_string(step));
}

/// The files asked for beside the result; write_fields writes the cells to the file it is given.
void write_files(const Options& options, const Json& result,
                 const std::function<void(const std::filesystem::path&)>& write_fields) {
  if (!options.fields.empty() && !one_file_a_step(options.fields)) write_fields(options.fields);
  if (!options.figure.empty()) draw_figure(options.figure, result, write_fields);
}

int answer_exactly(const solver::Scene& scene, const Options& options, std::ostream& text, Json& result) {
  const auto start = std::chrono::steady_clock::now();
  const Oracle oracle = require_oracle(scene);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result = exact_result(scene, oracle, seconds);
  text << exact_text(result);
  write_files(options, result, [&](const auto& file) { write_exact_fields(file, scene, oracle); });
  return 0;
}

int solve_on_grid(const solver::Scene& scene, const Options& options, std::ostream& text, Json& result) {
  const std::unique_ptr<ExactHistory> history = exact_history(scene);
  OracleAnswer exact;
  const bool has_history = scene.steps.size() > 1 || scene.cycles > 1;
  Json steps = Json::array();
  const auto on_step = [&](const solver::Solution& at) {
    exact = history->advance(at.loads);
    if (has_history) steps.push_back(step_result(scene, at, exact));
    if (one_file_a_step(options.fields)) {
      write_solution_fields(file_of_step(options.fields, std::max<std::size_t>(steps.size(), 1)), at, exact);
    }
  };
  solver::Solution solution;
  try {
    solution = solver::solve(scene, {.progress = show_progress, .on_step = on_step});
  } catch (const solver::InputError& error) {  // the steps before are not lost
    if (!steps.empty()) {
      result = {{"name", scene.name}, {"status", "not_converged"}, {"message", error.what()}};
      add_steps(result, std::move(steps));
    }
    throw;
  }
  result = solve_result(scene, solution, exact);
  if (has_history) add_steps(result, std::move(steps));
  text << solve_text(result);
  write_files(options, result, [&](const auto& file) { write_solution_fields(file, solution, exact); });
  return solution.status == solver::Status::converged ? 0 : 1;
}

int run(const Options& options, std::ostream& text, Json& result) {
  if (!options.fields.empty()) solver::require_field_format(options.fields);
  if (!options.figure.empty()) require_figure_format(options.figure);
  const solver::Scene scene = read_scene(options);
  const bool exact = scene.model == solver::ModelChoice::exact;
  return (exact ? answer_exactly : solve_on_grid)(scene, options, text, result);
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
  command->add_option(
      "--fields", options->fields,
      "write tractions, pressure, stick and, from a grid, slip: .h5, .csv or .vti; of a history the "
      "last step, or each to a file of its own where the name holds {step}");
  command->add_option("--figure", options->figure,
                      "draw slip and stick, tractions and pressure: .svg, .pdf or .png");
  command->footer(
      "Example:\n  slipstick solve convergence/scenes/paper.toml --set load.moment_ratio=0.5 --json "
      "result.json --fields "
      "fields.h5 --figure figure.svg\n  slipstick solve convergence/scenes/cone.toml --model exact\nExit "
      "code 0: converged; 1: "
      "not, result written all the same; 2: bad input, or gross slip "
      "asked for, or --model exact where no exact answer is known.");
  return
      [options](std::ostream& text, nlohmann::ordered_json& result) { return run(*options, text, result); };
}

}  // namespace slipstick::convergence
