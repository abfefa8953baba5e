#include "convergence/report/validation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <stdexcept>

#include "analytic/paper_equations.hpp"
#include "analytic/torsion.hpp"
#include "convergence/check/check.hpp"
#include "convergence/gates/gate_reader.hpp"
#include "convergence/gates/gate_report.hpp"
#include "convergence/gates/gate_run.hpp"
#include "convergence/oracle/oracle.hpp"
#include "convergence/report/exact_curves.hpp"
#include "convergence/report/scene_verdict.hpp"
#include "convergence/report/solved_stresses.hpp"
#include "convergence/results/result_parts.hpp"
#include "convergence/runs/run_spec.hpp"
#include "solver/input/field_file.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;
using solver::Index;

constexpr double kProfileRatios[] = {0.5, 0.9};
constexpr double kMethodsRatio = 0.9;  ///< load for the comparison of methods, as in the scene of the ellipse
constexpr const char* kMethods[] = {"coulomb", "paper"};
constexpr std::size_t kQuickHardStep = 10;  ///< every tenth hard case

/// How large the validation is.
struct ValidationSize {
  Index loading_cells;                ///< cells along each side for the loading curve and the maps
  std::vector<Index> mesh_cells;      ///< of the mesh study
  std::vector<Index> ellipse_cells;   ///< along the ellipse's long axis; half as many along the short one
  std::vector<double> moment_ratios;  ///< of the loading curve
};

ValidationSize size_for(Effort effort) {
  if (effort == Effort::quick) {
    return {.loading_cells = 48,
            .mesh_cells = {16, 32, 64},
            .ellipse_cells = {32, 64},
            .moment_ratios = {0.05, 0.2, 0.4, 0.6, 0.8, 0.95}};
  }
  ValidationSize size{.loading_cells = 128,
                      .mesh_cells = {32, 64, 128, 256},
                      .ellipse_cells = {64, 128, 256},
                      .moment_ratios = {0.01, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99}};
  if (effort == Effort::full) {
    size.mesh_cells.push_back(512);
    size.ellipse_cells.push_back(512);
  }
  return size;
}

/// Radial profile: exact, Eq. (1) as printed, and both over radii that crowd at the stick edge.
Json exact_profile(const analytic::TorsionState& state) {
  Json rows = Json::array();
  const double c = state.stick_ratio;
  const auto add = [&](double radius) {
    rows.push_back({{"radius", radius},
                    {"value", analytic::traction(state, radius)},
                    {"printed", analytic::paper::eq1_printed(c, radius)}});
  };
  constexpr int points = 120;
  for (int i = 0; i < points; ++i) add(c * std::sin(0.5 * std::numbers::pi * i / points));
  add(std::nextafter(c, 0.0));
  for (int i = 0; i <= points; ++i) add(c + (1.0 - c) * std::sin(0.5 * std::numbers::pi * i / points));
  return rows;
}

std::string method_override(const std::string& method) { return fmt::format("solver.method=\"{}\"", method); }

std::string fields_file(double moment_ratio) {
  return fmt::format("fields-{}{}", moment_ratio, solver::fields_ending());
}

/// The paper's sphere under another law of friction, with its overrides.
struct Beyond {
  const char* name;
  std::vector<std::string> overrides;
};

const std::vector<Beyond>& beyond_the_paper() {
  static const std::vector<Beyond> all{
      {"coulomb", {}},
      {"tresca", {"contact.friction_law=tresca", "contact.shear_strength=1.2e8"}},
      {"capped", {"contact.friction_law=capped", "contact.shear_strength=8e7"}},
      {"power", {"contact.friction_law=power", "contact.friction=2000", "contact.friction_exponent=0.5"}}};
  return all;
}
constexpr double kBeyondRatio = 0.7;

/// The runs of the page by its sections.
using Sections = std::map<std::string, std::vector<RunSpec>>;

Sections page_runs(const fs::path& scene, const fs::path& scenes, const ValidationSize& size, const fs::path& folder) {
  Sections runs;
  const auto at = [&](Index cells, double ratio, const char* method = "coulomb", const char* pressure = "solved") {
    return RunSpec{
        .scene = scene,
        .overrides = {fmt::format("grid.cells=[{0},{0}]", cells), fmt::format("contact.pressure=\"{}\"", pressure),
                      fmt::format("load.moment_ratio={}", ratio), method_override(method)}};
  };
  for (const double ratio : kProfileRatios) {
    RunSpec& run = runs["profiles"].emplace_back(at(size.loading_cells, ratio));
    run.fields = folder / fields_file(ratio);
    run.profile = true;
  }
  for (const char* method : kMethods) {
    for (const double ratio : size.moment_ratios) runs["loading"].push_back(at(size.loading_cells, ratio, method));
    for (const Index cells : size.mesh_cells) runs["methods"].push_back(at(cells, kMethodsRatio, method));
    for (const Index cells : size.ellipse_cells) {
      const std::string grid = fmt::format("grid.cells=[{},{}]", cells, cells / 2);
      runs["ellipse"].push_back({.scene = scenes / "ellipse.toml", .overrides = {grid, method_override(method)}});
    }
  }
  for (const char* pressure : {"solved", "hertz", "hertz_averaged"}) {
    for (const double ratio : kProfileRatios) {
      for (const Index cells : size.mesh_cells) runs["mesh"].push_back(at(cells, ratio, "coulomb", pressure));
    }
  }
  for (const Beyond& beyond : beyond_the_paper()) {
    for (const Index cells : size.mesh_cells) {
      RunSpec& run = runs[beyond.name].emplace_back(changed(at(cells, kBeyondRatio), beyond.overrides));
      run.profile = cells == size.mesh_cells.back();
    }
  }
  runs["stresses"] = stress_runs(scene, size.mesh_cells);
  runs["errata"].push_back(at(size.loading_cells, kMethodsRatio, "paper"));
  runs["cycle"].push_back(
      {.scene = scenes / "torsion_loop.toml", .overrides = {fmt::format("grid.cells=[{0},{0}]", size.loading_cells)}});
  return runs;
}

/// The results of each section, all solved in parallel. Throws std::runtime_error where one is missing.
std::map<std::string, std::vector<Json>> solve_all(const Sections& sections, const ProcessPool& pool) {
  std::vector<RunSpec> runs;
  for (const auto& [name, of_section] : sections) runs.insert(runs.end(), of_section.begin(), of_section.end());
  std::vector<Json> results = to_json(pool.run(runs));
  for (const Json& result : results) {
    if (is_failed(result))
      throw std::runtime_error(fmt::format("{}: {}", result.value("run", ""), result.value("message", "")));
  }
  std::map<std::string, std::vector<Json>> found;
  auto result = results.begin();
  for (const auto& [name, of_section] : sections) {
    const auto end = result + static_cast<std::ptrdiff_t>(of_section.size());
    std::move(result, end, std::back_inserter(found[name]));
    result = end;
  }
  return found;
}

Json profile(double moment_ratio, Json result) {
  Json computed = result.at("profile");
  result.erase("profile");
  const analytic::TorsionState state = analytic::from_moment_ratio(moment_ratio);
  return {{"moment_ratio", moment_ratio},    {"stick_ratio", state.stick_ratio},    {"exact", exact_profile(state)},
          {"computed", std::move(computed)}, {"fields", fields_file(moment_ratio)}, {"result", std::move(result)}};
}

/// Some keys of a result.
Json row_of(const Json& result, const std::vector<const char*>& keys) {
  Json row;
  for (const char* key : keys) row[key] = result[key];
  return row;
}

Json rows_of(const std::vector<Json>& results, const std::vector<const char*>& keys) {
  Json rows = Json::array();
  for (const Json& result : results) rows.push_back(row_of(result, keys));
  return rows;
}

/// A cycle of the moment, step by step, computed and exact.
Json cycle(const Json& result) {
  Json rows = Json::array();
  for (const Json& step : result.at("steps")) {
    Json& row = rows.emplace_back(row_of(step, {"moment_ratio", "twist", "dissipated"}));
    row.emplace("exact", number_at(step, "exact.twist"));
  }
  return {{"cells", result.at("cells")}, {"rows", std::move(rows)}};
}

/// In the order of their names.
std::vector<fs::path> settings_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

/// The published numbers. studies: also the gates whose number is extrapolated by a study.
std::vector<Judgement> literature(const fs::path& folder, bool studies, const ProcessPool& pool) {
  std::vector<Gate> gates;
  for (const fs::path& file : settings_files(folder)) {
    std::ranges::copy_if(read_gates(file), std::back_inserter(gates), [&](const Gate& gate) {
      return studies || !std::holds_alternative<StudySource>(gate.source);
    });
  }
  return run_gates(gates, pool);
}

/// The hard cases, or an even part of them, by each method.
HardResult hard_results(const fs::path& folder, std::size_t step, const ProcessPool& pool) {
  std::vector<HardCase> all;
  for (const fs::path& file : settings_files(folder)) {
    std::ranges::move(read_hard_cases(file), std::back_inserter(all));
  }
  std::vector<HardCase> shown;
  for (std::size_t i = 0; i < all.size(); i += step) shown.push_back(std::move(all[i]));
  return run_hard_cases(shown, {.variants = false, .finer_meshes = false, .methods = {read_beside_method("paper")}},
                        pool);
}

/// A field of check/fields/, at 0.9 of the limit moment. twist: rad, as the program reports it.
struct FieldFile {
  const char* program;
  const char* file;
  double twist;
  const char* expected;
};

constexpr FieldFile kFields[] = {{"CONTACT", "contact-64-0.9.csv", 2.361048651456917e-3, "good"},
                                 {"CGContact", "cgcontact-64-0.9.csv", 2.21775472e-3, "bad"}};

/// The verdicts of `check` on fields that other programs computed for the paper's sphere.
std::vector<KnownField> judge_peers(const fs::path& inputs) {
  const solver::Scene scene = solver::read_scene(inputs / "scenes" / "paper.toml", {"load.moment_ratio=0.9"});
  std::vector<KnownField> rows;
  for (const auto& [program, file, twist, expected] : kFields) {
    const Json result = to_json(check_field(scene, inputs / "check" / "fields" / file, {.twist = twist}));
    rows.push_back(
        {.program = program,
         .file = file,
         .expected = expected,
         .verdict = result.value("verdict", ""),
         .check = row_of(result, {"verdict", "why", "cells", "twist_error", "moment_error", "stick_radius_error",
                                  "traction_error", "certificate", "slip_direction", "judged"})});
  }
  return rows;
}

/// The paper's sphere under other laws of friction; on the finest mesh also the tractions along a radius.
Json beyond_rows(const std::map<std::string, std::vector<Json>>& results) {
  Json rows = Json::array();
  for (const auto& [name, overrides] : beyond_the_paper()) {
    const std::vector<Json>& by_mesh = results.at(name);
    rows.push_back({{"name", name},
                    {"rows", rows_of(by_mesh, {"cells", "twist_error", "moment_limit_error", "stick_radius_error",
                                               "traction_error", "operator_applications", "certificate"})},
                    {"profile", by_mesh.back().at("profile")}});
  }
  return rows;
}

/// The results of a method.
std::vector<Json> by_method(const std::vector<Json>& results, const std::string& method) {
  std::vector<Json> found;
  std::ranges::copy_if(results, std::back_inserter(found),
                       [&](const Json& result) { return result.value("method", "") == method; });
  return found;
}

/// The passing gate that is nearest to its bound; nullptr where none has a bound in numbers.
const Judgement* nearest_to_bound(const std::vector<Judgement>& gates) {
  const Judgement* found = nullptr;
  for (const Judgement& gate : gates) {
    const bool counts = gate.outcome == Outcome::passed && std::isfinite(gate.factor);
    if (counts && (found == nullptr || gate.factor > found->factor)) found = &gate;
  }
  return found;
}

/// The gates that fail, pass unexpectedly or are refused.
std::string wrong_gates(const std::vector<Judgement>& gates) {
  std::string line;
  for (const Judgement& gate : gates) {
    if (gate.outcome == Outcome::failed || gate.outcome == Outcome::passed_unexpectedly ||
        gate.outcome == Outcome::refused) {
      line += fmt::format("; {} {}", gate.gate.id, to_string(gate.outcome));
    }
  }
  return line;
}

long number_with(const std::vector<Judgement>& gates, Outcome outcome) {
  return std::ranges::count(gates, outcome, &Judgement::outcome);
}

Finding judge_literature(const std::vector<Judgement>& gates) {
  return {
      "Literature",
      fmt::format("{} of {} published numbers agree at their digits, {} differ for a known reason",
                  number_with(gates, Outcome::passed), gates.size(), number_with(gates, Outcome::failed_as_expected)) +
          wrong_gates(gates),
      shown(exit_code(gates) == 0)};
}

Finding judge_gates(const std::vector<Judgement>& gates) {
  std::string line = fmt::format("{} of {} pass", number_with(gates, Outcome::passed), gates.size());
  if (const long expected = number_with(gates, Outcome::failed_as_expected); expected > 0) {
    line += fmt::format(", {} fails as expected", expected);
  }
  line += wrong_gates(gates);
  if (const Judgement* const nearest = nearest_to_bound(gates); nearest != nullptr) {
    line += fmt::format("; nearest to its bound is {}, at {:.0f} % of it", nearest->gate.id, 100.0 * nearest->factor);
  }
  return {"Gates", line, shown(exit_code(gates) == 0)};
}

Finding judge_known_fields(const std::vector<KnownField>& peers) {
  Finding found{"Fields of others", ""};
  for (const KnownField& peer : peers) {
    found.line += fmt::format("{}{} is {}", found.line.empty() ? "" : ", ", peer.program, peer.verdict);
    if (peer.verdict == peer.expected) continue;
    found.line += fmt::format(" (known to be {})", peer.expected);
    found.shown = Shown::fails;
  }
  return found;
}

}  // namespace

std::vector<Stage> validation_stages(const Validation& request) {
  // Seconds on two processors.
  if (request.effort == Effort::quick) {
    return {{"validation", 5.0}, {"hard scenes", 110.0 / kQuickHardStep}, {"published numbers", 10.0}};
  }
  return {{"validation", 15.0}, {"hard scenes", 110.0}, {"published numbers", 60.0}, {"gates", 25.0}};
}

PaperValidation validate(const Validation& request, const fs::path& folder, const ProcessPool& pool) {
  const auto& [inputs, effort] = request;
  const ValidationSize size = size_for(effort);
  const fs::path scenes = inputs / "scenes";
  const fs::path scene_file = scenes / "paper.toml";
  const Oracle exact = *find_oracle(solver::read_scene(scene_file)).oracle;
  pool.progress().begin("validation");
  const auto results = solve_all(page_runs(scene_file, scenes, size, folder), pool);
  Json profiles = Json::array();
  for (std::size_t i = 0; i < std::size(kProfileRatios); ++i)
    profiles.push_back(profile(kProfileRatios[i], results.at("profiles")[i]));
  const std::vector<Json>& ellipses = results.at("ellipse");

  PaperValidation paper;
  paper.figures = exact_curves();
  Json& yield = paper.figures["first_yield"];
  yield["solved"] = solved_stresses(scene_file, yield["maps"].back(), results.at("stresses"));
  paper.figures.update(
      Json{{"contact", {{"radius", exact.contact_radius}, {"peak_pressure", exact.normal.peak_pressure}}},
           {"loading_cells", size.loading_cells},
           {"profiles", std::move(profiles)},
           {"loading", results.at("loading")},
           {"mesh", results.at("mesh")},
           {"methods", results.at("methods")},
           {"ellipse", rows_of(ellipses, {"method", "moment_ratio", "cells", "certificate", "slip_direction",
                                          "operator_applications", "iterations", "seconds", "twist"})},
           {"errata", errata(results.at("errata").front(), by_method(ellipses, "paper"))},
           {"cycle", cycle(results.at("cycle").front())},
           {"beyond", beyond_rows(results)}});
  const bool all = effort != Effort::quick;
  pool.progress().begin("hard scenes");
  paper.hard = hard_results(inputs / "hard", all ? 1 : kQuickHardStep, pool);
  paper.peers = judge_peers(inputs);
  pool.progress().begin("published numbers");
  paper.literature = literature(inputs / "literature", all, pool);
  if (all) {
    pool.progress().begin("gates");
    paper.gates = run_gates(read_gates(inputs / "gates" / "quick.toml"), pool);
  }
  return paper;
}

void to_json(Json& json, const KnownField& field) {
  json = {{"program", field.program}, {"file", field.file}, {"expected", field.expected}};
  json.update(field.check);
}

std::vector<Finding> judge_validation(const PaperValidation& paper) {
  Finding gates{"Gates", "not on a quick page; make gate runs them"};
  if (paper.gates) gates = judge_gates(*paper.gates);
  return {std::move(gates), judge_hard(paper.hard, "Hard scenes"), judge_known_fields(paper.peers),
          judge_literature(paper.literature)};
}

Json counts_json(const PaperValidation& paper) {
  Json counts{{"hard_scenes", counts_json(paper.hard)}};
  if (paper.gates) {
    counts.update(Json{{"gates", counts_json(*paper.gates)}});
  } else {
    set_missing(counts, "gates", "left out of a quick page");
  }
  return counts;
}

Json to_json(const PaperValidation& paper) {
  Json json = paper.figures;
  json.update(
      Json{{"hard", to_json(paper.hard)}, {"peers", paper.peers}, {"literature", gates_json(paper.literature)}});
  if (paper.gates) json.emplace("gates", gates_json(*paper.gates));
  return json;
}

}  // namespace slipstick::convergence
