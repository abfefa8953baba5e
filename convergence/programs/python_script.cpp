#include "convergence/programs/python_script.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "convergence/programs/package_module.hpp"
#include "convergence/programs/temporary_folder.hpp"
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

void run_report_script(const std::string& script, const std::vector<std::string>& arguments, const std::string& done) {
  const std::string python = python_interpreter();
  // -E ignores PYTHONPATH and PYTHONHOME; the script's folder replaces the working folder.
  constexpr const char* kRunScript =
      "import sys; del sys.argv[0]; sys.path[0] = sys.argv[0].rpartition('/')[0]; "
      "import runpy; runpy.run_path(sys.argv[0], run_name='__main__')";
  std::vector<std::string> words{python, "-E", "-c", kRunScript, project_file("reports") / script};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const ProgramEnd end = run_program(words, {.tied_by = own_program()});
  if (end.code != 0) {
    throw std::runtime_error(fmt::format("{}, but drawing failed ({} {} {})", done, python, script, end.trouble));
  }
}

void require_figure_format(const fs::path& figure, const std::string& option) {
  constexpr std::array kEndings{".svg", ".pdf", ".png"};
  if (std::ranges::find(kEndings, figure.extension()) == kEndings.end()) {
    throw solver::InputError(option, figure.string() + ": allowed endings: .svg, .pdf, .png");
  }
  solver::require_place_for(figure);
}

void draw_solve(const fs::path& figure, const Json& result, const fs::path& cells) {
  const fs::path json = cells.parent_path() / "result.json";
  solver::write_whole_file(json, json_text(result));
  run_report_script("solve_figure.py", {"--output=" + figure.string(), json, cells}, "the result is complete");
}

void draw_stresses(const fs::path& figure, const fs::path& volume) {
  run_report_script("stress_figure.py", {"--output=" + figure.string(), "--", volume}, "the volume is complete");
}

void draw_study(const fs::path& figure, const Json& result) {
  const TemporaryFolder folder;
  const fs::path json = folder / "study.json";
  solver::write_whole_file(json, json_text(result));
  run_report_script("study_figure.py", {"--", json, figure}, "the study is complete");
}

}  // namespace slipstick::convergence
