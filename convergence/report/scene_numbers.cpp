#include "convergence/report/scene_numbers.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "convergence/orders/expected_order.hpp"
#include "convergence/orders/limit.hpp"
#include "convergence/runs/path_uncertainty.hpp"
#include "convergence/runs/run_spec.hpp"
#include "convergence/studies/study_run.hpp"
#include "solver/model/make_model.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;
using solver::Index;
using solver::Scene;

/// The coarsest mesh of a study, cells along the longer side.
constexpr Index kFewestCells = 8;
/// Meshes of the study, and meshes of the answer, as parts of the finest one.
constexpr double kStudyParts[] = {0.125, 0.1875, 0.25, 0.375, 0.5, 0.75, 1.0};
constexpr double kAnswerParts[] = {0.25, 0.5, 1.0};
const std::vector<double> kStudyTolerances{1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8};
/// Loads below this part of the limit load are rounding errors.
constexpr double kRounded = 1e-9;

/// The basis of an error against an exact answer.
constexpr const char* kExact = "exact";

/// Names of the numbers of a page.
struct NumberName {
  const char* key;
  const char* words;
  const char* unit;
};
constexpr NumberName kNumbers[] = {{"twist_angle", "twist", "rad"},
                                   {"moment", "moment", "N m"},
                                   {"displacement", "displacement", "m"},
                                   {"force", "tangential force", "N"},
                                   {"moment_limit", "limit moment", "N m"},
                                   {"contact_radius", "contact radius", "m"},
                                   {"stick_radius", "stick radius", "m"},
                                   {"stick_ratio", "stick ratio", ""},
                                   {"peak_pressure", "highest pressure", "Pa"},
                                   {"approach", "approach", "m"},
                                   {"elastic_energy", "elastic energy", "J"},
                                   {"dissipated", "energy lost in the last step", "J"}};

Index longer_side(const Scene& scene) { return std::max(scene.grid.cells[0], scene.grid.cells[1]); }

/// Multiples of four that are these parts of the finest mesh, rising.
std::vector<Index> meshes(Index finest, const auto& parts) {
  std::vector<Index> cells;
  for (const double part : parts) {
    const auto rounded = 4 * static_cast<Index>(std::lround(part * static_cast<double>(finest) / 4.0));
    if (rounded >= kFewestCells && (cells.empty() || rounded > cells.back())) cells.push_back(rounded);
  }
  return cells;
}

bool is_rough(const Scene& scene) {
  return std::ranges::any_of(scene.surfaces,
                             [](const solver::Surface& surface) { return surface.shape == solver::Shape::roughness; });
}

/// How far the mesh may put a number on the finest mesh off, relative, and how that is known.
struct MeshError {
  double reference = kNaN;
  double error = kNaN;
  double uncertainty = kNaN;  ///< of the reference, relative
  std::string basis;          ///< "exact" and others, or why nothing is known
};

/// From the value to which a study of meshes tends, if it has one.
MeshError error_by_study(const StudyResult& study, const std::string& key, double value) {
  for (const SeriesResult& series : study.series) {
    const auto found = std::ranges::find(series.quantities, key, &QuantityResult::path);
    if (found == series.quantities.end() || !found->extrapolated) continue;
    const double reference = found->extrapolated->value;
    const double uncertainty = found->extrapolated->uncertainty / std::abs(reference);
    return {reference, std::abs(value / reference - 1.0) + uncertainty, uncertainty,
            fmt::format("study of meshes: {}", found->extrapolated->method)};
  }
  return {};
}

/// The key of the number to which the uncertainty of a result refers.
std::string resolved_number(const Json& result) { return result.at("resolved").value("number", ""); }

/// The mesh's error as the result states it, relative; NaN where the result's uncertainty refers to another number.
double stated_mesh_error(const Json& result, const std::string& key) {
  return resolved_number(result) == key ? number_at(result, "resolved.mesh") / size_at(result, key) : kNaN;
}

/// study: of meshes.
MeshError mesh_error(const Scene& scene, const std::vector<Json>& results, const StudyResult& study,
                     const std::string& key) {
  const Json& finest = results.back();
  const double value = size_at(finest, key);
  if (const double exact = size_at(finest, "exact." + key); exact > 0.0) {
    return {exact, value / exact - 1.0, 0.0, kExact};
  }
  if (!(value > 0.0)) return {.basis = "the value is zero, or there is none"};
  if (results.size() < 2) {
    if (resolved_number(finest) != key) return {.basis = "its files have its grid: there is no other mesh"};
    const double stated = stated_mesh_error(finest, key);
    return {value, stated, stated, "as the result states"};
  }
  std::vector<MeshSample> samples;
  samples.reserve(results.size());
  for (const Json& result : results) samples.push_back({number_at(result, "cell_size[0]"), size_at(result, key)});
  if (is_rough(scene)) {
    const double change = std::abs(value / samples[samples.size() - 2].value - 1.0);
    const double error = std::fmax(change, stated_mesh_error(finest, key));
    return {value, error, error,
            error > change ? "as the result states: finer meshes see more of the surface"
                           : "change from the mesh before: finer ones see more of the surface"};
  }
  const Limit limit = richardson_limit(samples, expected_order(key, scene).value);
  const double uncertainty = limit.uncertainty / std::abs(limit.value);
  const double error = std::abs(value / limit.value - 1.0) + uncertainty;
  const MeshError by_study = error_by_study(study, key, value);
  return by_study.error < error ? by_study : MeshError{limit.value, error, uncertainty, limit.method};
}

/// Whether a load, or the motion that it causes, is zero but for rounding.
bool is_rounding(const Json& result, const std::string& key) {
  if (size_at(result, "exact." + key) == 0.0) return true;
  const double friction = number_at(result, "friction_force");
  const bool no_force = size_at(result, "force") < kRounded * friction;
  const bool no_moment = size_at(result, "moment") < kRounded * size_at(result, "moment_limit");
  if (key == "twist_angle" || key == "moment") return no_moment;
  return (key == "displacement" || key == "force") && no_force;
}

/// The stick ratio says no more than the stick radius, unless it is the one of the two with an exact answer.
bool stands_for_radius(const Json& result, const std::string& key) {
  return key == "stick_ratio" &&
         !(std::isnan(size_at(result, "exact.stick_radius")) && size_at(result, "exact.stick_ratio") > 0.0);
}

/// The relative error of a number that the length of the steps causes: 0 where it cannot matter, NaN where
/// it is not known. `on_path`: whether the scene's answer depends on it.
double path_error(const Json& result, const std::string& key, bool on_path) {
  const bool of_pressure =
      key == "moment_limit" || key == "contact_radius" || key == "peak_pressure" || key == "approach";
  const bool shear_moves_pressure = result.contains("turns");
  if (!on_path || (of_pressure && !shear_moves_pressure)) return 0.0;
  if (result.contains("program")) return kNaN;
  return number_at(result, "resolved.paths." + key) / size_at(result, key);
}

/// The parts of an error and their sum. path: relative error by the length of the steps, NaN: unknown.
void add_error(PageNumber& row, const MeshError& mesh, double path) {
  const bool exact = mesh.basis == kExact;
  const std::string kWhole = "the error against the exact answer holds all parts";
  const std::string kNoPath =
      "the length of the steps changes this number by an unknown amount: compare with a larger "
      "solver.substeps";
  row.basis = mesh.basis;
  if (!exact && std::isnan(path)) {
    row.basis += "; " + kNoPath;
  } else if (!exact && path > kRounded * std::abs(mesh.error)) {
    row.basis = fmt::format("mesh {:.1e}, {}; length of the steps {:.1e}", std::abs(mesh.error), mesh.basis, path);
  }
  row.reference = number_or(mesh.reference, row.basis);
  row.error = number_or(exact ? mesh.error : std::abs(mesh.error) + path, row.basis);
  row.mesh = number_or(exact ? kNaN : std::abs(mesh.error), exact ? kWhole : row.basis);
  row.path = number_or(exact ? kNaN : path, exact ? kWhole : kNoPath);
  row.uncertainty = number_or(exact ? 0.0 : mesh.uncertainty + path, row.basis);
}

/// Coarser meshes for a long history, whose time is proportional to its steps.
PageSize for_history(PageSize size) {
  size.most_cells /= 2;
  size.most_study_cells /= 2;
  size.method_cells /= 2;
  size.operator_cells.resize(size.operator_cells.size() / 2);
  return size;
}

}  // namespace

PageSize for_program(PageSize size) {
  constexpr Index kSlower = 4;
  size.most_cells = std::max(size.most_cells / kSlower, 4 * kFewestCells);
  size.most_study_cells = size.most_cells;
  size.shifts = 1;
  return size;
}

Meshes meshes_of(const Scene& scene, const PageSize& size) {
  if (has_given_grid(scene)) return {true, {}, {}};
  const Index finest = std::max(std::min(longer_side(scene), size.most_cells), 4 * kFewestCells);
  const Index of_study = std::max(finest, std::min(2 * finest, size.most_study_cells));
  return {false, meshes(of_study, kStudyParts), meshes(finest, kAnswerParts)};
}

RunSpec PageScene::on(Index cells) const { return changed(base, {cells_override(scene, cells)}); }

PageScene page_scene(const RunSpec& base, const PageSize& size) {
  PageScene at{.base = base, .scene = solver::read_scene(base.scene, base.overrides), .size = size};
  at.own = at.scene.solver.program.empty();
  if (!at.own) at.size = for_program(size);
  at.shortened = at.scene.steps.size() * static_cast<std::size_t>(at.scene.cycles) > size.long_history;
  if (at.shortened) at.size = for_history(std::move(at.size));
  at.meshes = meshes_of(at.scene, at.size);
  return at;
}

std::vector<Json> solve_answer(const PageScene& at, const fs::path& fields, const ProcessPool& pool) {
  std::vector<RunSpec> runs;
  for (const Index cells : at.meshes.answer) runs.push_back(at.on(cells));
  if (runs.empty()) runs.push_back(at.base);
  runs.back().fields = fields;
  std::vector<Json> results = to_json(pool.run(runs));
  if (is_failed(results.back())) throw std::runtime_error(results.back().value("message", ""));
  std::erase_if(results, [](const Json& result) { return is_failed(result); });
  return results;
}

std::vector<StudyResult> scene_studies(const PageScene& at, const ProcessPool& pool) {
  const auto& [base, scene, size, meshes, own, shortened] = at;
  std::vector<StudyResult> found;
  Study study{.source = base.scene,
              .name = "meshes",
              .scene = base.scene,
              .overrides = base.overrides,
              .cells = meshes.study,
              .shifts = scene.steps.size() > 1 ? std::min(size.shifts, 2) : size.shifts,
              .tolerances = {},
              .variations = {},
              .quantities = {}};
  if (!meshes.given) found.push_back(run_study(study, pool));
  study.name = "tolerances";
  study.cells.clear();
  if (!meshes.given) study.cells = {meshes.answer[meshes.answer.size() / 2]};
  study.shifts = 1;
  study.tolerances = kStudyTolerances;
  found.push_back(run_study(study, pool));
  return found;
}

std::string words_of(const std::string& number) {
  const auto* const found = std::ranges::find(kNumbers, number, &NumberName::key);
  return found == std::end(kNumbers) ? number : found->words;
}

std::vector<PageNumber> number_rows(const Scene& scene, const std::vector<Json>& results, const StudyResult& study) {
  const solver::Model model = solver::make_model(scene);
  const bool on_path = depends_on_path(scene, model.pressure_coupling && model.law->couples());
  const Json& answer = results.back();
  std::vector<PageNumber> rows;
  for (const auto& [key, words, unit] : kNumbers) {
    const double value = size_at(answer, key);
    if (!(value > 0.0) || is_rounding(answer, key) || stands_for_radius(answer, key)) continue;
    rows.push_back({.key = key, .words = words, .unit = unit, .value = value});
    add_error(rows.back(), mesh_error(scene, results, study, key), path_error(answer, key, on_path));
  }
  return rows;
}

const PageNumber* find_row(const std::vector<PageNumber>& rows, const std::string& key) {
  const auto found = std::ranges::find(rows, key, &PageNumber::key);
  return found == rows.end() ? nullptr : &*found;
}

Reference reference_of(const Json& answer, const std::vector<PageNumber>& rows) {
  std::vector<std::string> keys{resolved_number(answer)};
  keys.insert(keys.end(), {"twist_angle", "displacement", "stick_radius", "stick_ratio", "approach"});
  for (const std::string& key : keys) {
    const PageNumber* const row = find_row(rows, key);
    if (row != nullptr && std::isfinite(row->error)) return {key, row->reference, row->uncertainty};
  }
  return {keys.back(), kNaN, kNaN};
}

}  // namespace slipstick::convergence
