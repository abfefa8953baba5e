#include "convergence/commands.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>
#include <memory>
#include <ostream>

#include "convergence/programs/python_script.hpp"
#include "convergence/report/scene_page.hpp"
#include "convergence/results/markup.hpp"
#include "convergence/results/output.hpp"
#include "convergence/runs/run_options.hpp"
#include "convergence/runs/run_spec.hpp"
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

/// Draws the pages whose results lie in folders' data/, and an index where there are several.
void draw(const std::vector<fs::path>& folders, const ReportRequest& request) {
  const fs::path benchmarks = fs::path(request.benchmarks) / "data";
  std::vector<std::string> words{"--output=" + request.output, "--benchmarks=" + benchmarks.string(), "--"};
  bool current = fs::exists(fs::path(request.output) / "index.html");
  for (const fs::path& folder : folders) {
    std::vector<fs::path> sources{folder / "data", project_file("reports")};
    if (fs::is_directory(benchmarks)) sources.push_back(benchmarks);
    current = current && is_current(folder / "index.html", sources);
    words.push_back(folder.string());
  }
  if (!current) run_report_script("render.py", words, "the results are in " + request.output);
}

/// The pool of the options; the programs to compare with may run, since the user names them.
ProcessPool pool_in(const fs::path& data, RunOptions runs, const std::vector<BesideMethod>& beside) {
  for (const BesideMethod& each : beside) runs.overrides.push_back(each.override);
  runs.output = data / "points";
  return runs.pool();
}

/// The folder of each page: the output folder, or for several scenes a folder in it with the name of the
/// scene's file. Throws InputError for two equal folders, and for a scene in the data of the page.
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

/// The page of the command line. Throws InputError for a word that cannot be read.
PageRequest page_request(const ReportRequest& request) {
  const Effort effort = request.quick ? Effort::quick : request.full ? Effort::full : Effort::usual;
  PageRequest page{.base = {.scene = {}, .overrides = request.runs.overrides}, .size = page_size(effort)};
  for (const std::string& word : request.wanted) page.wanted.push_back(read_wanted_error(word));
  for (const std::string& file : request.beside) page.beside.push_back(read_beside_method(file));
  page.uncertain = request.uncertain;
  if (request.scenes.empty()) page.validation = {project_file("convergence"), effort};
  return page;
}

std::string summary_row(const Page& page) {
  std::string lines;
  for (const Finding& finding : page.headline.findings)
    lines += fmt::format("{}{}: {}", lines.empty() ? "" : "\n", finding.what, finding.line);
  return fmt::format("| {} | {} | {} |", markdown_text(page.scene.name), page.headline.verdict(), markdown_text(lines));
}

/// A page for each scene. Exit code 1 where a verdict is bad.
int make_pages(PageRequest request, const ReportRequest& words, std::ostream& text, Json& result) {
  const std::vector<fs::path> folders = page_folders(words);
  for (const std::string& scene : words.scenes) solver::read_scene(scene, words.runs.overrides);
  std::vector<Stage> stages;
  for (const std::string& scene : words.scenes) {
    const std::string name = words.scenes.size() == 1 ? "" : fs::path(scene).stem().string();
    std::ranges::move(page_stages(request, name), std::back_inserter(stages));
  }
  constexpr double kFigures = 15.0;  // of a page, in the unit of page_stages()
  stages.push_back({"figures", kFigures * static_cast<double>(words.scenes.size())});
  *words.runs.progress = Progress(stages);
  std::vector<Page> pages;
  for (std::size_t i = 0; i < folders.size(); ++i) {
    const fs::path data = folders[i] / "data";
    const ProcessPool pool = pool_in(data, words.runs, request.beside);
    request.base.scene = words.scenes[i];
    {
      const Interrupts interrupts;
      pages.push_back(scene_page(request, data, pool));
    }
    text << pages.back().scene.name << ": " << headline_text(pages.back().headline)
         << "page: " << (folders[i] / "index.html").string() << '\n';
  }
  std::vector<JunitCase> cases;
  std::vector<std::string> rows;
  Json list = Json::array();
  for (const Page& page : pages) {
    std::ranges::move(page_cases(page), std::back_inserter(cases));
    rows.push_back(summary_row(page));
    list.push_back(to_json(page));
  }
  result = Json{{"pages", std::move(list)}};
  words.runs.progress->begin("figures");
  words.runs.progress->end();
  draw(folders, words);
  write_option_file("--junit", words.junit, junit_text("slipstick report", cases));
  append_option_file("--summary", words.summary,
                     markdown_with_table("### slipstick report\n\n", "| scene | verdict | why |", rows, "scenes"));
  return std::ranges::any_of(pages, [](const Page& page) { return page.headline.verdict() == "bad"; }) ? 1 : 0;
}

int run_report(ReportRequest request, std::ostream& text, Json& result) {
  require_output("--junit", request.junit);
  require_output("--summary", request.summary);
  PageRequest asked = page_request(request);
  if (asked.validation) {
    if (!request.runs.overrides.empty()) {
      throw solver::InputError("--program",
                               "the paper's validation is for this program only; allowed: scenes, as "
                               "`slipstick report convergence/scenes/paper.toml --program FILE`");
    }
    request.scenes.push_back(project_file("convergence/scenes/paper.toml"));
  }
  return make_pages(std::move(asked), request, text, result);
}

}  // namespace

RunCommand add_report_command(CLI::App& app) {
  const auto request = std::make_shared<ReportRequest>();
  CLI::App* const command = app.add_subcommand("report", "Draw the page of any scene: errors, orders, times, verdict");
  command->add_option("scene", request->scenes,
                      "scene files, a page for each (default: the paper's scene, with the paper's "
                      "validation)");
  command->add_option("--output", request->output, "folder for the page")->capture_default_str();
  CLI::Option* const quick =
      command->add_flag("--quick", request->quick, "small grids, no gates: seconds instead of minutes");
  command->add_flag("--full", request->full, "finer meshes: some minutes more")->excludes(quick);
  command
      ->add_option("--benchmarks", request->benchmarks,
                   "folder that `slipstick bench` wrote; the page shows its times where there are some")
      ->capture_default_str();
  command->add_option("--want", request->wanted,
                      "QUANTITY=ERROR, as twist=1e-3: the verdict is bad if the error by mesh and steps is "
                      "larger or unknown");
  command->add_option(
      "--uncertain", request->uncertain,
      "key=P%: standard uncertainties of the scene's numbers, e.g. friction=5%; the page has the resulting "
      "uncertainty of each number");
  command->add_option("--junit", request->junit, "write the verdicts of scenes as JUnit's XML");
  command->add_option("--summary", request->summary, "add the verdicts to this file as a table in Markdown");
  add_memory_option(*command, request->runs.memory_limit);
  request->runs.add_programs_to(*command);
  command
      ->add_option("--beside", request->beside,
                   "files of other programs (TOML): the page compares their answers, times and hard cases")
      ->delimiter(',');
  command->footer(
      "Example:\n  slipstick report --output build/report\n"
      "  slipstick report convergence/scenes/ellipse.toml --want twist=1e-2 --output build/ellipse\n"
      "  slipstick report convergence/scenes/*.toml --quick --output build/gallery\n"
      "Finished solves are kept: an interrupted command continues when it is repeated.\n"
      "Exit code 0: no verdict is bad; 1: a verdict is bad; 2: a page could not be made.");
  return [request](std::ostream& text, Json& result) { return run_report(*request, text, result); };
}

}  // namespace slipstick::convergence
