#include "convergence/runs/run_spec.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <variant>

#include "convergence/exchange/solver_program.hpp"
#include "convergence/results/markup.hpp"
#include "convergence/results/result_parts.hpp"
#include "convergence/runs/result_cache.hpp"
#include "solver/elasticity/law/law_kind.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/input_file.hpp"
#include "solver/scene/scene_keys.hpp"
#include "solver/scene/surface_geometry.hpp"

namespace slipstick::convergence {
namespace {

using solver::Scene;
using solver::Shape;
using solver::Surface;

constexpr solver::Index kWiderBy = 4;
constexpr double kMillimetres = 1e3;

void reverse(solver::TorsionLoad& torsion) {
  std::visit([](auto& load) { load.value = -load.value; }, torsion);
}

void mirror(Scene& scene) {
  for (Surface& surface : scene.surfaces) {
    surface.at[1] = -surface.at[1];
    surface.angle = -surface.angle;
  }
  for (solver::Step& step : scene.steps) {
    reverse(step.torsion);
    step.force[1] = -step.force[1];
    if (step.displacement) (*step.displacement)[1] = -(*step.displacement)[1];
  }
}

std::array<double, 2> turned(const std::array<double, 2>& vector) { return {-vector[1], vector[0]}; }

void turn(Scene& scene) {
  for (Surface& surface : scene.surfaces) {
    surface.at = turned(surface.at);
    surface.angle += std::numbers::pi / 2.0;
  }
  for (solver::Step& step : scene.steps) {
    step.force = turned(step.force);
    if (step.displacement) step.displacement = turned(*step.displacement);
  }
  std::swap(scene.grid.cells[0], scene.grid.cells[1]);
  if (scene.grid.extent) std::swap((*scene.grid.extent)[0], (*scene.grid.extent)[1]);
}

void shift(Scene& scene) {
  if (!scene.grid.extent) throw std::invalid_argument("a shifted scene needs its extent");
  std::array<double, 2> cell{};
  for (std::size_t i = 0; i < 2; ++i) {
    cell[i] = (*scene.grid.extent)[i] / static_cast<double>(scene.grid.cells[i]);
    scene.grid.cells[i] += 2 * kWiderBy;
    (*scene.grid.extent)[i] = cell[i] * static_cast<double>(scene.grid.cells[i]);
  }
  for (Surface& surface : scene.surfaces) {
    surface.at[0] += 2.0 * cell[0];
    surface.at[1] -= cell[1];
  }
}

/// Forces stay in N: stresses are in N/mm^2, moments in N mm.
void measure_in_millimetres(Scene& scene) {
  constexpr double of_stress = 1.0 / (kMillimetres * kMillimetres);
  for (solver::Material* const body : {&scene.upper, &scene.lower}) {
    body->young_modulus *= of_stress;
    if (body->yield_stress) *body->yield_stress *= of_stress;
    if (!body->coating) continue;
    body->coating->young_modulus *= of_stress;
    body->coating->thickness *= kMillimetres;
  }
  scene.contact.friction.shear_strength *= of_stress;
  if (scene.contact.friction.kind == solver::FrictionKind::power)
    scene.contact.friction.coefficient *= std::pow(of_stress, 1.0 - scene.contact.friction.exponent);
  for (std::size_t i = 0; i < scene.layer.values.size(); ++i) {
    const solver::LawParameter& parameter = scene.layer.kind->parameters[i];
    scene.layer.values[i] *= std::pow(kMillimetres, parameter.of_length) * std::pow(of_stress, parameter.of_stress);
  }
  for (Surface& s : scene.surfaces) {
    for (double* const length : solver::lengths(s)) *length *= kMillimetres;
    s.coefficient *= std::pow(kMillimetres, 1.0 - s.exponent);
    s.map.heights *= kMillimetres;
  }
  for (solver::Step& step : scene.steps) {
    if (auto* const moment = std::get_if<solver::Moment>(&step.torsion)) moment->value *= kMillimetres;
    if (!step.displacement) continue;
    for (double& along : *step.displacement) along *= kMillimetres;
  }
  if (scene.grid.extent) {
    for (double& side : *scene.grid.extent) side *= kMillimetres;
  }
}

/// Swapping the bodies reverses all loads.
void exchange(Scene& scene) {
  std::swap(scene.upper, scene.lower);
  for (solver::Step& step : scene.steps) {
    reverse(step.torsion);
    for (double& along : step.force) along = -along;
    if (!step.displacement) continue;
    for (double& along : *step.displacement) along = -along;
  }
}

struct Transformation {
  Variant variant;
  std::string_view word;
  void (*apply)(Scene&);
};
constexpr std::array kTransformations{
    Transformation{Variant::none, "none", [](Scene&) {}},
    Transformation{Variant::mirrored, "mirrored", mirror},
    Transformation{Variant::turned, "turned", turn},
    Transformation{Variant::shifted, "shifted", shift},
    Transformation{Variant::in_other_units, "in_other_units", measure_in_millimetres},
    Transformation{Variant::exchanged, "exchanged", exchange},
    Transformation{Variant::two_threads, "two_threads", [](Scene& scene) { scene.solver.threads = 2; }}};
static_assert(kTransformations.size() == kVariants.size() + 1);

const Transformation& transformation(Variant variant) {
  return *std::ranges::find(kTransformations, variant, &Transformation::variant);
}

/// Bytes of a file that stands in a key as it is; of a larger one, a height map or a program, its checksum does.
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
  if (spec.stress_error) text += "\nstress error";
  if (spec.step_before) text += "\nstep before";
  if (!spec.program_version.empty()) text += "\nversion " + spec.program_version;
  return text;
}

}  // namespace

std::string to_string(Variant variant) { return std::string(transformation(variant).word); }

Variant variant_of(const std::string& word) {
  const auto found = std::ranges::find(kTransformations, word, &Transformation::word);
  if (found == kTransformations.end()) throw std::invalid_argument(word + " is no variant");
  return found->variant;
}

std::string why_not(const Scene& scene, Variant variant) {
  if (variant == Variant::none || variant == Variant::two_threads) return "";
  if (scene.contact.pressure == solver::PressureModel::file) return "the pressure comes from a file";
  if (variant == Variant::exchanged) return "";
  if (!scene.contact.friction.map.empty() && variant != Variant::in_other_units)
    return "the friction is read on the grid's own axes";
  if (variant == Variant::shifted && std::ranges::any_of(scene.steps, solver::brings_translation))
    return "moments are about the origin";
  if (variant == Variant::shifted && scene.contact.pressure != solver::PressureModel::solved) {
    return "the given pressure stands at the origin";
  }
  for (const Surface& surface : scene.surfaces) {
    const bool drawn = surface.shape == Shape::roughness || surface.shape == Shape::height_map;
    if (drawn && variant != Variant::in_other_units) return "the surface is drawn or read on its own axes";
    if (surface.shape == Shape::height_map) return "the surface is read from a file";
  }
  return "";
}

Scene transformed(Scene scene, Variant variant) {
  transformation(variant).apply(scene);
  return scene;
}

RunSpec changed(RunSpec run, const std::vector<std::string>& overrides) {
  run.overrides.insert(run.overrides.end(), overrides.begin(), overrides.end());
  return run;
}

BesideMethod read_beside_method(const std::string& word) {
  if (word.ends_with(".toml")) return {read_solver_program(word).name, program_override(word), true};
  std::vector<std::string> allowed;
  for (const auto& [name, method] : solver::kMethods) {
    if (name == word) return {name, fmt::format("solver.method=\"{}\"", name), false};
    allowed.push_back(name);
  }
  throw solver::InputError("--beside " + word, fmt::format("is no method; allowed: {}, or a program's file "
                                                           "(.toml)",
                                                           fmt::join(allowed, ", ")));
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

SolveRecord not_computed(RunStatus status, const std::string& message, const RunSpec& spec) {
  SolveRecord record;
  record.status = status;
  record.message = message;
  record.run = run_text(spec);
  return record;
}

void FailedRuns::add(const std::string& name, const Json& result) {
  runs_[name] |= is_failed(result);
  if (!is_failed(result) || first_) return;
  const std::string message = result.value("message", "");
  first_ = {result.value("run", name), message.empty() ? "no reason is known" : message};
}

Json FailedRuns::json() const {
  Json json{{"count", count()}, {"of", runs_.size()}};
  if (first_) {
    json["first"] = {{"run", first_->first}, {"message", first_->second}};
  } else {
    set_missing(json, "first", "no run failed");
  }
  return json;
}

std::size_t FailedRuns::count() const {
  return static_cast<std::size_t>(std::ranges::count_if(runs_, [](const auto& run) { return run.second; }));
}

std::string FailedRuns::text() const { return failed_runs_text({{"failed_runs", json()}}); }

std::string failed_runs_text(const Json& result) {
  const auto runs = result.find("failed_runs");
  if (runs == result.end() || runs->at("count") == 0) return "";
  const Json& first = runs->at("first");
  return fmt::format("{} of {} runs failed; the first ({}): {}", runs->at("count").get<int>(),
                     runs->at("of").get<int>(), first.at("run").get<std::string>(),
                     first.at("message").get<std::string>());
}

}  // namespace slipstick::convergence
