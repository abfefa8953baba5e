#include "convergence/runs/run_spec.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>

#include "solver/input/input_file.hpp"

namespace slipstick::convergence {
namespace {

/// FNV-1a.
std::uint64_t hash(const std::string& text) {
  std::uint64_t value = 14695981039346656037ULL;
  for (const char c : text) value = (value ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return value;
}

std::string cache_key(const RunSpec& spec, const solver::Scene& scene) {
  std::string text = read_text(spec.scene) + run_text(spec);
  for (const solver::Surface& surface : scene.surfaces) {
    if (!surface.file.empty()) text += read_text(surface.file);
  }
  if (!scene.pressure_file.empty()) text += read_text(scene.pressure_file);
  if (!spec.fields.empty()) text += "\nfields " + spec.fields.string();
  if (spec.profile) text += "\nprofile";
  return text;
}

}  // namespace

PreparedRun prepare_run(const RunSpec& spec) {
  PreparedRun run{.spec = spec,
                  .scene = seen_as(solver::read_scene(spec.scene, spec.overrides), spec.variant),
                  .cache_key = {},
                  .name = {}};
  run.cache_key = cache_key(spec, run.scene);
  run.name = fmt::format("{}-{:016x}", spec.scene.stem().string(), hash(run.cache_key));
  return run;
}

std::string read_text(const std::filesystem::path& file) {
  return solver::read_input_file(file, solver::kLargestTable, "a regular file");
}

std::string cells_override(const solver::Scene& scene, solver::Index across) {
  const solver::Index longer = std::max(scene.cells[0], scene.cells[1]);
  return fmt::format("grid.cells=[{},{}]", across * scene.cells[0] / longer,
                     across * scene.cells[1] / longer);
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
