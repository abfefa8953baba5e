#include "convergence/runs/run_spec.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "convergence/exchange/solver_program.hpp"
#include "convergence/results/markup.hpp"
#include "convergence/runs/result_cache.hpp"
#include "solver/input/input_file.hpp"
#include "solver/scene/surface_geometry.hpp"

namespace slipstick::convergence {
namespace {

/// Bytes of a file that stands in a key as it is; of a larger one, a height map or a program, its checksum
/// does.
constexpr std::size_t kWholeFile = 65536;

std::string cache_key(const RunSpec& spec, const solver::Scene& scene) {
  std::string text = read_text(spec.scene) + run_text(spec);
  const std::vector<std::filesystem::path> files = input_files(scene);
  for (std::size_t i = 1; i < files.size(); ++i) {
    const std::string content = read_text(files[i]);
    text += content.size() <= kWholeFile ? content : fmt::format("\n{:016x}", checksum(content));
  }
  if (!spec.fields.empty()) text += "\nfields " + spec.fields.string();
  if (spec.profile) text += "\nprofile";
  if (spec.step_before) text += "\nstep before";
  if (!spec.program_version.empty()) text += "\nversion " + spec.program_version;
  return text;
}

}  // namespace

RunSpec changed(RunSpec run, const std::vector<std::string>& overrides) {
  run.overrides.insert(run.overrides.end(), overrides.begin(), overrides.end());
  return run;
}

std::string complaint_of_file(const std::string& message, const std::vector<std::string>& command_line) {
  constexpr std::string_view kSet = "--set";
  if (!message.starts_with(kSet)) return "";
  const std::string rest = message.substr(message.find_first_not_of(": ", kSet.size()));
  const auto names = [&](const std::string& set) { return rest.starts_with(set.substr(0, set.find('='))); };
  return std::ranges::any_of(command_line, names) ? "" : rest;
}

PreparedRun prepare_run(const RunSpec& spec) {
  PreparedRun run{.spec = spec,
                  .scene = transformed(solver::read_scene(spec.scene, spec.overrides), spec.variant),
                  .cache_key = {},
                  .name = {}};
  const std::string answer_depends_on = cache_key(spec, run.scene);
  run.cache_key = as_utf8(answer_depends_on);  // as a file of JSON gives it back
  run.name = fmt::format("{}-{:016x}", spec.scene.stem().string(), checksum(answer_depends_on));
  return run;
}

std::vector<std::filesystem::path> input_files(const solver::Scene& scene) {
  std::vector<std::filesystem::path> files{scene.source};
  for (const solver::Surface& surface : scene.surfaces) {
    if (!surface.map.file.empty()) files.push_back(surface.map.file);
  }
  for (const std::filesystem::path& file : {scene.contact.pressure_file, scene.contact.friction.map}) {
    if (!file.empty()) files.push_back(file);
  }
  if (scene.solver.program.empty()) return files;
  for (std::filesystem::path& file : program_files(read_solver_program(scene.solver.program))) {
    files.push_back(std::move(file));
  }
  return files;
}

std::string read_text(const std::filesystem::path& file) {
  return solver::read_input_file(file, solver::kLargestTextTable, "a regular file");
}

std::string cells_override(const solver::Scene& scene, solver::Index across) {
  const solver::Index longer = std::max(scene.grid.cells[0], scene.grid.cells[1]);
  return fmt::format("grid.cells=[{},{}]", across * scene.grid.cells[0] / longer,
                     across * scene.grid.cells[1] / longer);
}

bool has_given_grid(const solver::Scene& scene) {
  return scene.contact.pressure == solver::PressureModel::file || !scene.contact.friction.map.empty() ||
         solver::find_height_map(scene.surfaces) != nullptr;
}

std::filesystem::path step_before_file(const std::filesystem::path& fields) {
  std::filesystem::path name = fields.stem();
  name += "-before";
  name += fields.extension();
  return fields.parent_path() / name;
}

std::string run_text(const RunSpec& spec) {
  std::string text = spec.scene.stem().string();
  for (const std::string& assignment : spec.overrides) text += ", " + assignment;
  if (spec.rounding == Rounding::upward) text += ", rounded upward";
  if (spec.rounding == Rounding::downward) text += ", rounded downward";
  if (spec.variant != Variant::none) text += ", " + to_string(spec.variant);
  return text;
}

}  // namespace slipstick::convergence
