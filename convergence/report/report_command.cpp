#include "convergence/commands.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "convergence/programs/python_script.hpp"
#include "convergence/report/headline.hpp"
#include "convergence/report/validation.hpp"
#include "convergence/runs/failed_runs.hpp"
#include "convergence/runs/run_options.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/input_file.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;

struct ReportRequest {
  std::string scene;
  std::string output = "build/report";
  std::string benchmarks = "build/benchmarks";
  bool quick = false;
  bool full = false;
  std::optional<std::uint64_t> memory_limit;
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

int run_report(const ReportRequest& request, std::ostream& text, Json& result) {
  const fs::path inputs = project_file("convergence");
  const fs::path scene = request.scene.empty() ? inputs / "scenes" / "paper.toml" : fs::path(request.scene);
  const fs::path output = request.output;
  const fs::path data = output / "data";
  if (solver::lies_within(scene, data)) {  // the program's own scenes are copied there
    throw solver::InputError(scene.string(), "lies in the page's data; allowed: a scene elsewhere");
  }
  const ProcessPool pool = RunOptions{.output = data / "points", .memory_limit = request.memory_limit}.pool();
  {
    const Interrupts interrupts;
    result = validate(scene, inputs, size_of(request), data, pool);
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

}  // namespace

RunCommand add_report_command(CLI::App& app) {
  const auto request = std::make_shared<ReportRequest>();
  CLI::App* const command = app.add_subcommand("report", "Run the paper's validation and draw the page");
  command->add_option("scene", request->scene, "scene file; left out: the paper's own case");
  command->add_option("--output", request->output, "folder for the page")->capture_default_str();
  CLI::Option* const quick =
      command->add_flag("--quick", request->quick, "small grids, no gates: seconds instead of minutes");
  command->add_flag("--full", request->full, "finer meshes: some minutes more")->excludes(quick);
  command
      ->add_option("--benchmarks", request->benchmarks,
                   "folder that `slipstick bench` wrote; the page shows its times where there are some")
      ->capture_default_str();
  add_memory_option(*command, request->memory_limit);
  command->footer(
      "Example:\n  slipstick report --output build/report\nFinished solves are kept: repeating an "
      "interrupted command goes on from there.\nExit code 0: done; 1: a run of a study failed, and the page "
      "says so; 2: it could not be made.");
  return [request](std::ostream& text, Json& result) { return run_report(*request, text, result); };
}

}  // namespace slipstick::convergence
