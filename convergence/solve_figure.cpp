#include "convergence/solve_figure.hpp"

#include <stdlib.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <stdexcept>
#include <string>

#include "convergence/python_script.hpp"
#include "solver/input_error.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;

/// A folder that goes when this goes.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = fs::temp_directory_path() / "slipstick-XXXXXX";
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error(name + ": cannot be made");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  fs::path operator/(const char* file) const { return path_ / file; }

 private:
  fs::path path_;
};

}  // namespace

void require_figure_format(const fs::path& figure) {
  constexpr std::array kEndings{".svg", ".pdf", ".png"};
  if (std::ranges::find(kEndings, figure.extension()) == kEndings.end()) {
    throw solver::InputError("--figure", figure.string() + ": allowed endings: .svg, .pdf, .png");
  }
}

void draw_figure(const fs::path& figure, const Json& result,
                 const std::function<void(const fs::path&)>& write_fields) {
  const TemporaryFolder folder;
  const fs::path json = folder / "result.json";
  const fs::path fields = folder / "fields.h5";
  std::ofstream(json) << result.dump() << '\n';
  write_fields(fields);
  run_report_script("solve_figure.py", {json, fields, "--output", figure}, "the result is complete");
}

}  // namespace slipstick::convergence
