#include "convergence/commands.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "convergence/programs/output_options.hpp"
#include "convergence/programs/python_script.hpp"
#include "convergence/runs/run_options.hpp"
#include "convergence/runs/run_spec.hpp"
#include "convergence/studies/study_run.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

struct StudyRequest {
  std::string study;
  std::string figure;
  RunOptions runs{.output = "build/studies"};
};

bool all_converged(const StudyResult& result) {
  return std::ranges::all_of(result.series, [](const SeriesResult& series) {
    return std::ranges::all_of(series.rows, [](const StudyRow& row) { return row.status == "converged"; });
  });
}

int run_study_of(const CLI::App& command, const StudyRequest& request, std::ostream& text, Json& result) {
  if (!request.figure.empty()) require_figure_format(request.figure);
  const Study study = read_study(request.study, request.runs.overrides);
  require_inputs_kept(command, input_files(solver::read_scene(study.scene, study.overrides)));
  std::vector<PreparedRun> lacking;
  const ProcessPool pool = request.runs.pool(&lacking);
  StudyResult found;
  {
    const Interrupts interrupts;
    found = run_study(study, pool);
  }
  if (!request.runs.list.empty()) return request.runs.write_list(lacking, text, result);
  result = to_json(found);
  text << study_text(found);
  if (!request.figure.empty()) draw_study(request.figure, result);
  return found.failed_runs.count() == 0 && all_converged(found) ? 0 : 1;
}

int run_study_request(const CLI::App& command, const StudyRequest& request, std::ostream& text, Json& result) {
  try {
    return run_study_of(command, request, text, result);
  } catch (const solver::InputError& error) {
    const std::string of_file = complaint_of_file(error.what(), request.runs.overrides);
    if (of_file.empty()) throw;
    throw solver::InputError(request.study, of_file);
  }
}

}  // namespace

RunCommand add_study_command(CLI::App& app) {
  const auto request = std::make_shared<StudyRequest>();
  CLI::App* const command =
      app.add_subcommand("study", "Solve a scene on many meshes or to many tolerances; judge orders and errors");
  command->add_option("study", request->study, "study file (TOML)")->required();
  add_set_option(*command, request->runs.overrides, "override a key of the scene, for all series");
  command->add_option("--figure", request->figure, "draw errors, orders and budget: .svg, .pdf or .png");
  request->runs.add_to(*command);
  request->runs.add_programs_to(*command);
  request->runs.add_list_to(*command, {"--figure"});
  command->footer(
      "Example:\n  slipstick study convergence/studies/paper_mesh.toml --figure study.svg --json study.json\n"
      "Finished solves are kept: an interrupted command continues when it is repeated.\n"
      "Exit code 0: done; 1: some solve did not converge or failed, and is marked; 2: bad input.");
  return running(command, request, run_study_request);
}

}  // namespace slipstick::convergence
