#include "convergence/python_script.hpp"

#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;

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

}  // namespace

fs::path project_file(const fs::path& relative) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = program.parent_path().parent_path() / "share" / "slipstick" / relative;
  return !error && fs::exists(installed) ? installed : fs::path(SLIPSTICK_SOURCE_DIR) / relative;
}

void run_report_script(const std::string& script, const std::vector<std::string>& arguments,
                       const std::string& done) {
  const std::string python = SLIPSTICK_PYTHON;
  if (python.empty()) {
    throw std::runtime_error(fmt::format(
        "{}, but no python3 with numpy, matplotlib, jinja2 and h5py was found when this program "
        "was built. On Debian or Ubuntu: apt-get install python3-numpy python3-matplotlib "
        "python3-jinja2 python3-h5py; elsewhere configure with -DSLIPSTICK_PYTHON=/path/to/python3",
        done));
  }
  std::vector<std::string> words{python, project_file("reports") / script};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const int status = run_program(words);
  if (status != 0) {
    throw std::runtime_error(
        fmt::format("{}, but drawing failed ({} {} ended with {})", done, python, script, status));
  }
}

}  // namespace slipstick::convergence
