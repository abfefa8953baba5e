#include "convergence/programs/python_script.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "convergence/results/json_text.hpp"
#include "convergence/system/machine.hpp"
#include "convergence/system/run_program.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/whole_file.hpp"

namespace slipstick::convergence {

namespace fs = std::filesystem;

fs::path project_file(const fs::path& relative) {
  const fs::path program = own_program_file();
  const fs::path installed = program.parent_path().parent_path() / "share" / "slipstick" / relative;
  return !program.empty() && fs::exists(installed) ? installed : fs::path(SLIPSTICK_SOURCE_DIR) / relative;
}

void run_report_script(const std::string& script, const std::vector<std::string>& arguments,
                       const std::string& done) {
  const std::string python = SLIPSTICK_PYTHON;
  if (python.empty()) {
    throw std::runtime_error(fmt::format(
        "{}, but no python3 with numpy, scipy, matplotlib, jinja2 and h5py was found when this program "
        "was built. On Debian or Ubuntu: apt-get install python3-numpy python3-scipy python3-matplotlib "
        "python3-jinja2 python3-h5py; elsewhere configure with -DSLIPSTICK_PYTHON=/path/to/python3",
        done));
  }
  // -I ignores PYTHONPATH, PYTHONHOME and the working folder; the script imports from its own folder.
  constexpr const char* kRunScript =
      "import runpy, sys; del sys.argv[0]; sys.path.insert(0, sys.argv[0].rpartition('/')[0]); "
      "runpy.run_path(sys.argv[0], run_name='__main__')";
  std::vector<std::string> words{python, "-I", "-c", kRunScript, project_file("reports") / script};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const ProgramEnd end = run_program(words, {.tied_by = own_program()});
  if (end.code != 0) {
    throw std::runtime_error(
        fmt::format("{}, but drawing failed ({} {} {})", done, python, script, end.trouble));
  }
}

void require_figure_format(const fs::path& figure) {
  constexpr std::array kEndings{".svg", ".pdf", ".png"};
  if (std::ranges::find(kEndings, figure.extension()) == kEndings.end()) {
    throw solver::InputError("--figure", figure.string() + ": allowed endings: .svg, .pdf, .png");
  }
  solver::require_place_for(figure);
}

void draw_solve(const fs::path& figure, const Json& result, const TemporaryFolder& folder) {
  const fs::path json = folder / "result.json";
  solver::write_whole_file(json, json_text(result));
  const bool of_steps = figure.string().find("{step}") != std::string::npos;
  run_report_script("solve_figure.py",
                    {"--output=" + figure.string(), json, folder / (of_steps ? kFieldsOfSteps : kFieldsFile)},
                    "the result is complete");
}

void draw_study(const fs::path& figure, const Json& result) {
  const TemporaryFolder folder;
  const fs::path json = folder / "study.json";
  solver::write_whole_file(json, json_text(result));
  run_report_script("study_figure.py", {"--", json, figure}, "the study is complete");
}

}  // namespace slipstick::convergence
