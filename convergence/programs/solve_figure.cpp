#include "convergence/programs/solve_figure.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "convergence/programs/python_script.hpp"
#include "convergence/programs/temporary_folder.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/whole_file.hpp"

namespace slipstick::convergence {
namespace fs = std::filesystem;

void require_figure_format(const fs::path& figure) {
  constexpr std::array kEndings{".svg", ".pdf", ".png"};
  if (std::ranges::find(kEndings, figure.extension()) == kEndings.end()) {
    throw solver::InputError("--figure", figure.string() + ": allowed endings: .svg, .pdf, .png");
  }
  solver::require_place_for(figure);
}

void draw_figure(const fs::path& figure, const Json& result,
                 const std::function<void(const fs::path&)>& write_fields) {
  const TemporaryFolder folder;
  const fs::path json = folder / "result.json";
  const fs::path fields = folder / "fields.h5";
  solver::write_whole_file(json, result.dump(-1, ' ', false, Json::error_handler_t::replace));
  write_fields(fields);
  run_report_script("solve_figure.py", {"--output=" + figure.string(), json, fields},
                    "the result is complete");
}

}  // namespace slipstick::convergence
