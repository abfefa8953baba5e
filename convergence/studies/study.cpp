#include "convergence/studies/study.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <functional>

#include "solver/input/input_error.hpp"
#include "solver/input/toml_reader.hpp"

namespace slipstick::convergence {
namespace {

using solver::Index;
using solver::SceneReader;

/// Cells along the longer side: with fewer a contact has no inside; with more one field takes gigabytes.
constexpr double kMinStudyCells = 8.0;
constexpr double kMaxStudyCells = 16384.0;
/// More grids do not change the spread.
constexpr double kMaxShifts = 32.0;
/// Solves of a study, without tightened and rounded ones. More take days, and a wrong list may give billions.
constexpr double kMaxSolves = 10'000.0;

std::vector<Index> read_cells(SceneReader& reader) {
  std::vector<Index> cells;
  for (const double number : reader.numbers("cells")) {
    cells.push_back(static_cast<Index>(number));
  }
  std::sort(cells.begin(), cells.end());
  const auto twice = std::adjacent_find(cells.begin(), cells.end());
  if (twice != cells.end()) reader.fail("cells", fmt::format("{} twice", *twice), "each mesh once");
  return cells;
}

std::vector<Variation> read_variations(SceneReader& reader) {
  std::vector<Variation> variations;
  const std::size_t count = reader.count("vary");
  for (std::size_t i = 0; i < count; ++i) {
    const std::string at = fmt::format("vary[{}].", i);
    variations.push_back({reader.text(at + "key"), reader.list(at + "values")});
    if (variations.back().values.empty()) reader.fail(at + "values", "(missing)", "a list of values");
    for (const char* own : {"grid.cells", "solver.tolerance"}) {
      if (variations.back().key == own) {
        reader.fail(at + "key", own, "a key of the scene, except grid.cells and solver.tolerance");
      }
    }
  }
  return variations;
}

void require_finite(const std::filesystem::path& file, const Study& study) {
  const auto at_least_one = [](std::size_t count) { return static_cast<double>(std::max<std::size_t>(1, count)); };
  double solves = at_least_one(study.cells.size()) * at_least_one(study.tolerances.size()) * study.shifts;
  for (const Variation& variation : study.variations) solves *= static_cast<double>(variation.values.size());
  if (solves > kMaxSolves) {
    throw solver::InputError(file.string(), fmt::format("has {:g} solves; allowed: at most {:g}, cells times "
                                                        "shifts times tolerances times the values of each [[vary]]",
                                                        solves, kMaxSolves));
  }
}

}  // namespace

const solver::SettingKeys& study_keys() {
  using namespace solver;
  static const SettingKeys keys{
      {"name", KeyType::text, "", "the file's name", {}, "Title of the output."},
      {"scene", KeyType::file, "", kRequired, kAny, "Scene file (TOML), relative to the study's folder."},
      {"set", KeyType::table, "", "none", kAny, "Keys of the scene that differ from its file."},
      {"cells", KeyType::numbers, "", "the scene's own grid", whole(kMinStudyCells, kMaxStudyCells),
       "Cells along the longer side of each mesh."},
      {"shifts", KeyType::number, "", fmt::format("{}", Study{}.shifts), whole(1.0, kMaxShifts),
       "Grids of each mesh, with other positions of the cells under the edges: they give a mean and a "
       "spread."},
      {"tolerances", KeyType::numbers, "", "the scene's own", kPositive, "Tolerances to which each mesh is solved."},
      {"vary", KeyType::tables, "", "none", kAny, "Tables `[[vary]]`: every combination is a series of its own."},
      {"vary.key", KeyType::text, "", kRequired, kAny,
       "The key of the scene that varies, except grid.cells and solver.tolerance."},
      {"vary.values", KeyType::values, "", kRequired, kAny, "The values of the key."},
      {"quantities", KeyType::texts, "", "all that have an expected order", kAny,
       "Paths into a result, as in `quantity` of a gate; and `stress_error.l1`, `.l2`, `.max`, of the "
       "stresses at 0.4 contact radii of depth."}};
  return keys;
}

Study read_study(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  SceneReader reader(file, {}, study_keys());
  Study study;
  study.source = file;
  study.name = reader.text_or("name", file.stem().string());
  study.scene = reader.path("scene");
  study.overrides = reader.assignments("set");
  study.overrides.insert(study.overrides.end(), overrides.begin(), overrides.end());
  study.cells = read_cells(reader);
  study.shifts = static_cast<int>(reader.number_or("shifts", study.shifts));
  study.tolerances = reader.numbers("tolerances");
  std::sort(study.tolerances.begin(), study.tolerances.end(), std::greater<>());
  study.variations = read_variations(reader);
  study.quantities = reader.texts("quantities");
  reader.reject_unknown();
  if (study.cells.size() < 2 && study.tolerances.size() < 2 && study.variations.empty()) {
    throw solver::InputError(file.string(), "nothing varies; allowed: several cells, several tolerances, or [[vary]]");
  }
  require_finite(file, study);
  return study;
}

}  // namespace slipstick::convergence
