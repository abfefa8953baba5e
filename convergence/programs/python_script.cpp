#include "convergence/programs/python_script.hpp"

#include <fmt/core.h>

#include <stdexcept>

#include "convergence/programs/run_program.hpp"

namespace slipstick::convergence {

namespace fs = std::filesystem;

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
  const ProgramEnd end = run_program(words, {.tied_by = kOwnProgram});
  if (end.code != 0) {
    throw std::runtime_error(
        fmt::format("{}, but drawing failed ({} {} {})", done, python, script, end.trouble));
  }
}

}  // namespace slipstick::convergence
