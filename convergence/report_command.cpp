#include "convergence/report_command.hpp"

#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "convergence/validation.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string scene;
  std::string output = "build/report";
  bool quick = false;
};

/// A file of the project: where it was installed beside the program, or in the source tree it was built from.
fs::path project_file(const fs::path& relative) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = program.parent_path().parent_path() / "share" / "slipstick" / relative;
  return !error && fs::exists(installed) ? installed : fs::path(SLIPSTICK_SOURCE_DIR) / relative;
}

/// Runs a program and waits; returns its exit code.
int run_program(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_t child = 0;
  if (posix_spawnp(&child, arguments[0], nullptr, nullptr, arguments.data(), environ) != 0) return -1;
  int status = 0;
  return waitpid(child, &status, 0) == child && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

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

void draw(const fs::path& data, const fs::path& output) {
  const fs::path scripts = project_file("reports");
  if (is_current(output / "index.html", {data, scripts})) return;
  const std::string python = SLIPSTICK_PYTHON;
  if (python.empty()) {
    throw std::runtime_error(fmt::format(
        "the results are in {}, but no python3 with numpy, matplotlib, jinja2 and h5py was found when "
        "this program was built. On Debian or Ubuntu: apt-get install python3-numpy "
        "python3-matplotlib python3-jinja2 python3-h5py; elsewhere configure with "
        "-DSLIPSTICK_PYTHON=/path/to/python3",
        data.string()));
  }
  const int status = run_program({python, scripts / "render.py", data.string(), "--output", output.string()});
  if (status != 0) {
    throw std::runtime_error(
        fmt::format("the results are in {}, but drawing the page failed ({} ended with {})", data.string(),
                    python, status));
  }
}

int run(const Options& options, std::ostream& text, nlohmann::ordered_json& result) {
  const fs::path scenes = project_file("convergence/scenes");
  const fs::path scene = options.scene.empty() ? scenes / "paper.toml" : fs::path(options.scene);
  const fs::path output = options.output;
  const fs::path data = output / "data";
  result =
      validate(scene, scenes / "ellipse.toml", options.quick ? quick_validation() : full_validation(), data);
  draw(data, output);
  text << "page: " << (output / "index.html").string() << '\n';
  return 0;
}

}  // namespace

std::function<int(std::ostream&, nlohmann::ordered_json&)> add_report_command(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand("report", "Run the paper's validation and draw the page");
  command->add_option("scene", options->scene, "scene file; left out: the paper's own case");
  command->add_option("--output", options->output, "folder for the page")->capture_default_str();
  command->add_flag("--quick", options->quick, "small grids: seconds instead of a minute");
  command->footer(
      "Example:\n  slipstick report --output build/report\nFinished solves are kept: repeating an "
      "interrupted "
      "command goes on from there.");
  return
      [options](std::ostream& text, nlohmann::ordered_json& result) { return run(*options, text, result); };
}

}  // namespace slipstick::convergence
