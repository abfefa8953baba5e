#include "convergence/report/validation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <stdexcept>

#include "analytic/paper_equations.hpp"
#include "analytic/torsion.hpp"
#include "convergence/check/check.hpp"
#include "convergence/gates/gate_reader.hpp"
#include "convergence/gates/gate_report.hpp"
#include "convergence/gates/gate_run.hpp"
#include "convergence/hard/hard_run.hpp"
#include "convergence/oracle/oracle.hpp"
#include "convergence/runs/failed_runs.hpp"
#include "convergence/runs/run_batch.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;
using solver::Index;

constexpr double kProfileRatios[] = {0.5, 0.9};
constexpr double kMethodsRatio =
    0.9;  ///< load at which methods are compared, and that of the ellipse's scene
constexpr const char* kPressures[] = {"solved", "hertz", "hertz_averaged"};
constexpr const char* kMethods[] = {"coulomb", "projected_gradient", "paper"};

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

/// The scene at one mesh, pressure model and load, by one method.
struct MeshPoint {
  Index cells;
  std::string pressure;
  double moment_ratio;
  std::string method = "coulomb";

  std::vector<std::string> overrides() const {
    return {fmt::format("grid.cells=[{0},{0}]", cells), fmt::format("contact.pressure=\"{}\"", pressure),
            fmt::format("load.moment_ratio={}", moment_ratio), method_override(method)};
  }
  static std::string method_override(const std::string& method) {
    return fmt::format("solver.method=\"{}\"", method);
  }
};

std::string fields_file(double moment_ratio) { return fmt::format("fields-{}.h5", moment_ratio); }

/// What the paper's sphere may have besides, as users set it.
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

Sections page_runs(const fs::path& scene, const fs::path& scenes, const ValidationSize& size,
                   const fs::path& folder) {
  Sections runs;
  const auto add = [&](const char* section, const MeshPoint& point) {
    runs[section].push_back({.scene = scene, .overrides = point.overrides()});
  };
  for (const double ratio : kProfileRatios) {
    add("profiles", {size.loading_cells, "solved", ratio});
    runs["profiles"].back().fields = folder / fields_file(ratio);
    runs["profiles"].back().profile = true;
  }
  for (const char* method : {"coulomb", "paper"}) {
    for (const double ratio : size.moment_ratios)
      add("loading", {size.loading_cells, "solved", ratio, method});
  }
  for (const char* pressure : kPressures) {
    for (const double ratio : kProfileRatios) {
      for (const Index cells : size.mesh_cells) add("mesh", {cells, pressure, ratio});
    }
  }
  for (const char* method : kMethods) {
    for (const Index cells : size.mesh_cells) add("methods", {cells, "solved", kMethodsRatio, method});
    for (const Index cells : size.ellipse_cells) {
      runs["ellipse"].push_back({.scene = scenes / "ellipse.toml",
                                 .overrides = {fmt::format("grid.cells=[{},{}]", cells, cells / 2),
                                               MeshPoint::method_override(method)}});
    }
  }
  for (const Beyond& beyond : beyond_the_paper()) {
    for (const Index cells : size.mesh_cells) {
      add(beyond.name, {cells, "solved", kBeyondRatio});
      RunSpec& run = runs[beyond.name].back();
      run.overrides.insert(run.overrides.end(), beyond.overrides.begin(), beyond.overrides.end());
      run.profile = cells == size.mesh_cells.back();
    }
  }
  add("errata", {size.loading_cells, "solved", kMethodsRatio, "paper"});
  runs["cycle"].push_back({.scene = scenes / "torsion_loop.toml",
                           .overrides = {fmt::format("grid.cells=[{0},{0}]", size.loading_cells)}});
  return runs;
}

/// The results of each section, all computed side by side. Throws std::runtime_error where one is missing.
std::map<std::string, std::vector<Json>> solve_all(const Sections& sections, const ProcessPool& pool) {
  std::map<std::string, std::vector<Json>> found;
  RunBatch batch;
  for (const auto& [name, runs] : sections) {
    for (const RunSpec& run : runs) {
      batch.add(run, [&into = found[name]](const Json& result) {
        if (is_failed(result)) {
          throw std::runtime_error(
              fmt::format("{}: {}", result["run"].get<std::string>(), result["message"].get<std::string>()));
        }
        into.push_back(result);
      });
    }
  }
  batch.run(pool);
  return found;
}

Json profile(double moment_ratio, Json result) {
  const Json computed = result["profile"];
  result.erase("profile");
  const analytic::TorsionState state = analytic::from_moment_ratio(moment_ratio);
  return {{"moment_ratio", moment_ratio},        {"stick_ratio", state.stick_ratio},
          {"exact", exact_profile(state)},       {"computed", computed},
          {"fields", fields_file(moment_ratio)}, {"result", std::move(result)}};
}

/// Some keys of each result.
Json rows_of(const std::vector<Json>& results, const std::vector<const char*>& keys) {
  Json rows = Json::array();
  for (const Json& result : results) {
    Json& row = rows.emplace_back();
    for (const char* key : keys) row[key] = result[key];
  }
  return rows;
}

/// A cycle of the moment, step by step, computed beside exact.
Json cycle(const Json& result) {
  Json rows = Json::array();
  for (const Json& step : result["steps"]) {
    rows.push_back({{"moment_ratio", step["moment_ratio"]},
                    {"twist", step["twist"]},
                    {"exact", step["exact"]["twist"]},
                    {"dissipated", step["dissipated"]}});
  }
  return {{"cells", result["cells"]}, {"rows", std::move(rows)}};
}

/// The rows of one method.
Json by_method(const Json& rows, const std::string& method) {
  Json found = Json::array();
  for (const Json& row : rows) {
    if (row["method"] == method) found.push_back(row);
  }
  return found;
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

/// The published numbers beside ours; those of single solves, or also those that studies extrapolate.
Json literature(const fs::path& folder, bool studies, const ProcessPool& pool) {
  std::vector<Gate> gates;
  for (const fs::path& file : settings_files(folder)) {
    std::ranges::copy_if(read_gates(file), std::back_inserter(gates), [&](const Gate& gate) {
      return studies || !std::holds_alternative<StudySource>(gate.source);
    });
  }
  return gates_json(run_gates(gates, pool));
}

/// The hard cases, or an even part of them, by each method.
Json hard_results(const fs::path& folder, std::size_t step, const ProcessPool& pool) {
  std::vector<HardCase> all;
  for (const fs::path& file : settings_files(folder)) {
    std::ranges::move(read_hard_cases(file), std::back_inserter(all));
  }
  std::vector<HardCase> shown;
  for (std::size_t i = 0; i < all.size(); i += step) shown.push_back(std::move(all[i]));
  return to_json(
      run_hard_cases(shown,
                     {.variants = false,
                      .finer_meshes = false,
                      .methods = {read_beside_method("projected_gradient"), read_beside_method("paper")}},
                     pool));
}

/// A field of check/fields/, at 0.9 of the limit moment.
struct KnownField {
  const char* program;
  const char* file;
  double twist;  ///< rad, that the program reported
  const char* expected;
};

constexpr KnownField kFields[] = {{"CONTACT", "contact-64-0.9.csv", 2.361048651456917e-3, "good"},
                                  {"CGContact", "cgcontact-64-0.9.csv", 2.21775472e-3, "bad"}};

/// What `check` says of fields that other programs computed for the paper's sphere and whose worth is known:
/// a row for each, with its program, the verdict and the one that is expected. `inputs` has the scenes
/// (scenes/) and the fields (check/fields/).
Json judge_peers(const std::filesystem::path& inputs) {
  const solver::Scene scene = solver::read_scene(inputs / "scenes" / "paper.toml", {"load.moment_ratio=0.9"});
  Json rows = Json::array();
  for (const KnownField& field : kFields) {
    const Json result =
        to_json(check_field(scene, inputs / "check" / "fields" / field.file, {.twist = field.twist}));
    Json& row = rows.emplace_back(
        Json{{"program", field.program}, {"file", field.file}, {"expected", field.expected}});
    for (const char* key : {"verdict", "why", "cells", "twist_error", "moment_error", "stick_radius_error",
                            "traction_error", "certificate", "slip_direction", "judged"}) {
      row[key] = result[key];
    }
  }
  return rows;
}

}  // namespace

ValidationSize page_validation() {
  return {.loading_cells = 128,
          .mesh_cells = {32, 64, 128, 256},
          .ellipse_cells = {64, 128, 256},
          .moment_ratios = {0.01, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99},
          .hard_step = 1,
          .gates = true};
}

ValidationSize full_validation() {
  ValidationSize size = page_validation();
  size.mesh_cells.push_back(512);
  size.ellipse_cells.push_back(512);
  return size;
}

ValidationSize quick_validation() {
  return {.loading_cells = 48,
          .mesh_cells = {16, 32, 64},
          .ellipse_cells = {32, 64},
          .moment_ratios = {0.05, 0.2, 0.4, 0.6, 0.8, 0.95},
          .hard_step = 10,
          .gates = false};
}

Json validate(const Validation& asked, const fs::path& folder, const ProcessPool& pool) {
  const auto& [inputs, size] = asked;
  const fs::path scenes = inputs / "scenes";
  const fs::path scene_file = scenes / "paper.toml";
  const Oracle exact = *find_oracle(solver::read_scene(scene_file)).oracle;
  const auto results = solve_all(page_runs(scene_file, scenes, size, folder), pool);

  Json paper;
  paper["contact"] = {{"radius", exact.contact_radius}, {"peak_pressure", exact.peak_pressure}};
  paper["loading_cells"] = size.loading_cells;
  paper.update(exact_curves());
  paper["profiles"] = Json::array();
  for (std::size_t i = 0; i < std::size(kProfileRatios); ++i) {
    paper["profiles"].push_back(profile(kProfileRatios[i], results.at("profiles")[i]));
  }
  for (const char* section : {"loading", "mesh", "methods"}) paper[section] = results.at(section);
  paper["ellipse"] = rows_of(  // that need no exact answer
      results.at("ellipse"), {"method", "moment_ratio", "cells", "certificate", "slip_direction",
                              "operator_applications", "iterations", "seconds", "twist"});
  paper["errata"] = errata(results.at("errata").front(), by_method(paper["ellipse"], "paper"));
  paper["hard"] = hard_results(inputs / "hard", size.hard_step, pool);
  paper["cycle"] = cycle(results.at("cycle").front());
  for (const auto& [name, overrides] : beyond_the_paper()) {
    const std::vector<Json>& by_mesh = results.at(name);  // on the finest one tractions along the radius too
    paper["beyond"].push_back(
        {{"name", name},
         {"rows", rows_of(by_mesh, {"cells", "twist_error", "moment_limit_error", "stick_radius_error",
                                    "traction_error", "operator_applications", "certificate"})},
         {"profile", by_mesh.back()["profile"]}});
  }
  paper["peers"] = judge_peers(inputs);
  paper["literature"] = literature(inputs / "literature", size.gates, pool);
  if (size.gates) paper["gates"] = gates_json(run_gates(read_gates(inputs / "gates" / "quick.toml"), pool));
  return paper;
}

}  // namespace slipstick::convergence
