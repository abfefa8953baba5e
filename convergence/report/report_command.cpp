#include "convergence/commands.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "convergence/programs/python_script.hpp"
#include "convergence/report/headline.hpp"
#include "convergence/report/scene_page.hpp"
#include "convergence/report/validation.hpp"
#include "convergence/results/markup.hpp"
#include "convergence/results/output.hpp"
#include "convergence/results/verdict_files.hpp"
#include "convergence/runs/failed_runs.hpp"
#include "convergence/runs/run_options.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/input_file.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;

struct ReportRequest {
  std::vector<std::string> scenes;
  std::string output = "build/report";
  std::string benchmarks = "build/benchmarks";
  bool quick = false;
  bool full = false;
  std::vector<std::string> wanted;
  std::vector<std::string> uncertain;
  std::string junit;
  std::string summary;
  std::vector<std::string> beside;
  RunOptions runs;
};

/// Whether the page is newer than all that it is made from.
bool is_current(const fs::path& page, const std::vector<fs::path>& sources) {
  if (!fs::exists(page)) return false;
  for (const fs::path& folder : sources) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.is_regular_file() && entry.last_write_time() > fs::last_write_time(page)) return false;
    }
  }
  return true;
}

/// What the user asked for: seconds, a page, or the long form.
ValidationSize size_of(const ReportRequest& request) {
  if (request.quick) return quick_validation();
  return request.full ? full_validation() : page_validation();
}

void draw(const fs::path& data, const fs::path& benchmarks, const fs::path& output) {
  std::vector<fs::path> sources{data, project_file("reports")};
  if (fs::is_directory(benchmarks)) sources.push_back(benchmarks);
  if (is_current(output / "index.html", sources)) return;
  run_report_script("render.py",
                    {"--output=" + output.string(), "--benchmarks=" + benchmarks.string(), "--", data},
                    "the results are in " + data.string());
}

ProcessPool pool_in(const fs::path& data, const ReportRequest& request) {
  RunOptions runs = request.runs;
  for (const std::string& file : request.beside) runs.overrides.push_back(program_override(file));
  runs.output = data / "points";
  return runs.pool();
}

/// The paper's own case.
int run_validation(const ReportRequest& request, std::ostream& text, Json& result) {
  const fs::path output = request.output;
  const fs::path data = output / "data";
  const ProcessPool pool = pool_in(data, request);
  {
    const Interrupts interrupts;
    result = validate(project_file("convergence"), size_of(request), data, pool);
  }
  draw(data, fs::path(request.benchmarks) / "data", output);
  text << headline_text(result["headline"]) << "page: " << (output / "index.html").string() << '\n';
  int exit_code = 0;
  for (const auto& study : result["studies"]) {
    const std::string failures = failed_runs_text(study);
    if (failures.empty()) continue;
    text << fmt::format("study {}: {}\n", study["name"].get<std::string>(), failures);
    exit_code = 1;
  }
  return exit_code;
}

/// Where the page of each scene goes: the folder itself, or of several scenes one below it for each, named
/// after its file. Throws InputError where two would have one folder, or a scene lies in the page's data.
std::vector<fs::path> page_folders(const ReportRequest& request) {
  std::vector<fs::path> folders;
  for (const std::string& scene : request.scenes) {
    const fs::path folder =
        request.scenes.size() == 1 ? fs::path(request.output) : request.output / fs::path(scene).stem();
    if (std::ranges::find(folders, folder) != folders.end()) {
      throw solver::InputError(scene, "another scene's file has this name; allowed: one page for each name");
    }
    if (solver::lies_within(scene, folder / "data")) {
      throw solver::InputError(scene, "lies in the page's data; allowed: a scene elsewhere");
    }
    folders.push_back(folder);
  }
  return folders;
}

/// A page for each scene. Exit code 1 where a page says bad.
int run_scenes(const ReportRequest& request, std::ostream& text, Json& result) {
  const PageSize size = request.quick ? quick_page() : request.full ? full_page() : usual_page();
  const std::vector<fs::path> folders = page_folders(request);
  std::vector<WantedError> wanted;
  for (const std::string& word : request.wanted) wanted.push_back(read_wanted_error(word));
  std::vector<BesideMethod> beside;
  for (const std::string& file : request.beside) beside.push_back(read_beside_method(file));
  for (const std::string& scene : request.scenes) solver::read_scene(scene, request.runs.overrides);
  std::vector<JunitCase> cases;
  std::vector<std::string> rows;
  std::vector<std::string> drawn;
  bool good = true;
  for (std::size_t i = 0; i < folders.size(); ++i) {
    const fs::path data = folders[i] / "data";
    const ProcessPool pool = pool_in(data, request);
    Json page;
    {
      const Interrupts interrupts;
      page = scene_page({{.scene = request.scenes[i], .overrides = request.runs.overrides},
                         size,
                         wanted,
                         request.uncertain,
                         beside},
                        data, pool);
    }
    const Json& headline = page["headline"];
    text << page["scene"]["name"].get<std::string>() << ": " << headline_text(headline)
         << "page: " << (folders[i] / "index.html").string() << '\n';
    good = good && headline["verdict"] == "good";
    for (JunitCase& each : page_cases(page)) cases.push_back(std::move(each));
    std::string lines;
    for (const Json& line : headline["lines"]) {
      lines += fmt::format("{}{}: {}", lines.empty() ? "" : "\n", line[0].get<std::string>(),
                           line[1].get<std::string>());
    }
    rows.push_back(fmt::format("| {} | {} | {} |", markdown_cell(page["scene"]["name"].get<std::string>()),
                               headline["verdict"].get<std::string>(), markdown_cell(lines)));
    result["pages"].push_back(std::move(page));
    drawn.push_back(folders[i].string());
  }
  drawn.insert(drawn.begin(), "--output=" + request.output);
  run_report_script("scene_page.py", drawn, "the results are in " + request.output);
  write_option_file("--junit", request.junit, junit_text("slipstick report", cases));
  write_option_file(
      "--summary", request.summary,
      markdown_with_table("### slipstick report\n\n", "| scene | verdict | why |", rows, "scenes"));
  return good ? 0 : 1;
}

int run_report(const ReportRequest& request, std::ostream& text, Json& result) {
  require_output("--junit", request.junit);
  require_output("--summary", request.summary);
  if (request.scenes.empty() && !request.runs.overrides.empty()) {
    throw solver::InputError("--program",
                             "the paper's validation is this program's own; allowed: scenes, as "
                             "`slipstick report convergence/scenes/paper.toml --program FILE`");
  }
  return request.scenes.empty() ? run_validation(request, text, result) : run_scenes(request, text, result);
}

}  // namespace

RunCommand add_report_command(CLI::App& app) {
  const auto request = std::make_shared<ReportRequest>();
  CLI::App* const command =
      app.add_subcommand("report", "Draw the page of any scene: errors, orders, times, verdict");
  command->add_option(
      "scene", request->scenes,
      "scene files, a page for each; left out: the paper's validation, computed against exact");
  command->add_option("--output", request->output, "folder for the page")->capture_default_str();
  CLI::Option* const quick =
      command->add_flag("--quick", request->quick, "small grids, no gates: seconds instead of minutes");
  command->add_flag("--full", request->full, "finer meshes: some minutes more")->excludes(quick);
  command
      ->add_option("--benchmarks", request->benchmarks,
                   "folder that `slipstick bench` wrote; the page shows its times where there are some")
      ->capture_default_str();
  command->add_option("--want", request->wanted,
                      "QUANTITY=ERROR, as twist=1e-3: the verdict is bad where the mesh leaves more open");
  command->add_option(
      "--uncertain", request->uncertain,
      "key=P%: standard uncertainties of the scene's numbers, e.g. friction=5%; the page says what they "
      "make of each number");
  command->add_option("--junit", request->junit, "write the verdicts of scenes as JUnit's XML");
  command->add_option("--summary", request->summary, "write them as a table in Markdown");
  add_memory_option(*command, request->runs.memory_limit);
  request->runs.add_programs_to(*command);
  command
      ->add_option(
          "--beside", request->beside,
          "files of other programs (TOML), whose answers, times and hard cases the page shows beside")
      ->delimiter(',');
  command->footer(
      "Example:\n  slipstick report --output build/report\n  slipstick report "
      "convergence/scenes/rough_sphere.toml "
      "--want twist=1e-2 --output build/rough\nFinished solves are kept: repeating an "
      "interrupted command goes on from there.\nExit code 0: done; 1: the page of a scene says bad, or a run "
      "of "
      "a study failed; 2: it could not be made.");
  return [request](std::ostream& text, Json& result) { return run_report(*request, text, result); };
}

}  // namespace slipstick::convergence
