#include "convergence/report/validation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analytic/paper_equations.hpp"
#include "analytic/torsion.hpp"
#include "convergence/oracle/errors.hpp"
#include "convergence/oracle/oracle.hpp"
#include "convergence/report/exact_curves.hpp"
#include "convergence/report/gallery.hpp"
#include "convergence/results/provenance.hpp"
#include "convergence/results/result.hpp"
#include "convergence/runs/result_cache.hpp"
#include "convergence/runs/runner.hpp"
#include "convergence/studies/study.hpp"
#include "solver/input/input_error.hpp"

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

/// Traction over mu p0 in the cells beside the positive x1 axis and along the diagonal, with the exact
/// values.
Json computed_profile(const solver::Solution& solution, const Oracle& oracle) {
  const solver::Model& model = solution.model;
  const ExactFields exact = exact_fields(oracle, model);
  const double unit = model.stress_unit / (oracle.friction * oracle.reference_pressure);
  const Eigen::ArrayXd value = unit * solver::norms(solution.tangential.traction);
  const Eigen::ArrayXd exact_value = unit * solver::norms(exact.traction);
  const solver::Grid& grid = model.grid;
  Json rows = Json::array();
  const auto add = [&](Index i, Index j) {
    const Index cell = i * grid.n2 + j;
    const double radius = std::hypot(grid.x1(i), grid.x2(j)) * model.length_unit / oracle.contact_radius;
    if (radius > 1.0) return;
    rows.push_back({{"radius", radius},
                    {"value", value[cell]},
                    {"exact", exact_value[cell]},
                    {"error", value[cell] - exact_value[cell]}});
  };
  for (Index i = grid.n1 / 2; i < grid.n1; ++i) add(i, grid.n2 / 2);
  for (Index i = grid.n1 / 2 + 1; i < grid.n1; ++i) add(i, i);
  return rows;
}

/// The scene at one mesh, pressure model and load, by one method.
struct MeshPoint {
  Index cells;
  std::string pressure;
  double moment_ratio;
  std::string method = "coulomb";

  std::string name() const { return fmt::format("{}-{}-{}-{}", method, pressure, cells, moment_ratio); }
  std::vector<std::string> overrides() const {
    return {fmt::format("grid.cells=[{0},{0}]", cells), fmt::format("contact.pressure=\"{}\"", pressure),
            fmt::format("load.moment_ratio={}", moment_ratio), method_override(method)};
  }
  static std::string method_override(const std::string& method) {
    return fmt::format("solver.method=\"{}\"", method);
  }
};

Json profile(Runner& runner, const fs::path& scene_file, const fs::path& folder, Index cells,
             double moment_ratio) {
  const std::string fields = fmt::format("fields-{}.h5", moment_ratio);
  const MeshPoint point{cells, "solved", moment_ratio};
  Json result = runner.solve(
      point.name() + "-profile", scene_file, point.overrides(),
      [&](Json& computed, const solver::Solution& solution, const OracleAnswer& exact) {
        write_solution_fields(folder / fields, solution, exact);
        computed["profile"] = computed_profile(solution, *exact.oracle);
      },
      folder / fields);
  Json computed = result["profile"];
  result.erase("profile");
  const analytic::TorsionState state = analytic::from_moment_ratio(moment_ratio);
  return {{"moment_ratio", moment_ratio},
          {"stick_ratio", state.stick_ratio},
          {"exact", exact_profile(state)},
          {"computed", computed},
          {"fields", fields},
          {"result", result}};
}

/// The rows of one method.
Json by_method(const Json& rows, const std::string& method) {
  Json found = Json::array();
  for (const Json& row : rows) {
    if (row["method"] == method) found.push_back(row);
  }
  return found;
}

Json summary(const solver::Scene& scene, const Oracle& oracle) {
  const auto row = [](const char* label, const std::string& value) { return Json::array({label, value}); };
  return Json::array({
      row("Sphere radius", fmt::format("{:g} mm", 1e3 * scene.surfaces.front().radius)),
      row("Young's moduli", fmt::format("{:g} GPa (upper), {:g} GPa (lower)",
                                        1e-9 * scene.upper.young_modulus, 1e-9 * scene.lower.young_modulus)),
      row("Poisson's ratios",
          fmt::format("{:g}, {:g}", scene.upper.poisson_ratio, scene.lower.poisson_ratio)),
      row("Normal load", fmt::format("{:g} N", *scene.steps[0].normal)),
      row("Friction coefficient", fmt::format("{:g}", scene.friction)),
      row("Contact radius (Hertz)", fmt::format("{:.6g} mm", 1e3 * oracle.contact_radius)),
      row("Peak pressure (Hertz)", fmt::format("{:.6g} MPa", 1e-6 * oracle.peak_pressure)),
      row("Limit moment, Eq. (6)", fmt::format("{:.6g} N mm", 1e3 * oracle.moment_limit)),
  });
}

}  // namespace

namespace {

/// The studies of meshes and tolerances, of the scene at hand, up to so many cells.
Json study_results(const fs::path& scene_file, const fs::path& studies, Index most, const fs::path& folder) {
  PointRunner runner(folder / "points");
  Json results = Json::array();
  for (const char* file : {"paper_mesh.toml", "paper_tolerance.toml"}) {
    Study study = read_study(studies / file);
    study.scene = scene_file;
    for (Index& cells : study.cells) cells = std::min(cells, most);
    study.cells.erase(std::unique(study.cells.begin(), study.cells.end()), study.cells.end());
    results.push_back(run_study(study, runner));
  }
  return results;
}

}  // namespace

ValidationSize full_validation() {
  return {.loading_cells = 128,
          .mesh_cells = {32, 64, 128, 256},
          .ellipse_cells = {64, 128, 256},
          .gallery_cells = {64, 128, 256},
          .moment_ratios = {0.01, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99},
          .study_cells = 512};
}

ValidationSize quick_validation() {
  return {.loading_cells = 48,
          .mesh_cells = {16, 32, 64},
          .ellipse_cells = {32, 64},
          .gallery_cells = {16, 32, 64},
          .moment_ratios = {0.05, 0.2, 0.4, 0.6, 0.8, 0.95},
          .study_cells = 64};
}

Json validate(const fs::path& scene_file, const fs::path& scenes, const fs::path& studies,
              const ValidationSize& size, const fs::path& folder) {
  const solver::Scene scene = solver::read_scene(scene_file);
  if (scene.surfaces.front().shape != solver::Shape::sphere) {  // whose equations the paper's are
    throw solver::InputError(scene_file.string(), "upper.shape",
                             fmt::format("\"{}\"", to_string(scene.surfaces.front().shape)), "sphere");
  }
  const OracleAnswer exact = find_oracle(scene);
  if (!exact.oracle) {
    throw solver::InputError(scene_file.string(), "the page compares with exact values: " + exact.reason);
  }
  fs::create_directories(folder);
  const auto solves = std::size(kProfileRatios) * (1 + size.mesh_cells.size() * std::size(kPressures)) +
                      2 * size.moment_ratios.size() +
                      std::size(kMethods) * (size.mesh_cells.size() + size.ellipse_cells.size()) + 1 +
                      gallery_solves();
  Runner runner(folder, solves);
  const auto solve = [&](const MeshPoint& point) {
    return runner.solve(point.name(), scene_file, point.overrides());
  };

  Json report;
  report["provenance"] = provenance(scene.threads);
  report["scene"] = {
      {"name", scene.name}, {"text", read_text(scene_file)}, {"summary", summary(scene, *exact.oracle)}};
  report["contact"] = {{"radius", exact.oracle->contact_radius},
                       {"peak_pressure", exact.oracle->peak_pressure},
                       {"approach", exact.oracle->approach},
                       {"moment_limit", exact.oracle->moment_limit}};
  report["loading_cells"] = size.loading_cells;
  report.update(exact_curves());
  report["profiles"] = Json::array();
  for (const double ratio : kProfileRatios) {
    report["profiles"].push_back(profile(runner, scene_file, folder, size.loading_cells, ratio));
  }
  report["loading"] = Json::array();
  for (const char* method : {"coulomb", "paper"}) {
    for (const double ratio : size.moment_ratios) {
      report["loading"].push_back(solve({size.loading_cells, "solved", ratio, method}));
    }
  }
  report["mesh"] = Json::array();
  for (const char* pressure : kPressures) {
    for (const double ratio : kProfileRatios) {
      for (const Index cells : size.mesh_cells) report["mesh"].push_back(solve({cells, pressure, ratio}));
    }
  }
  report["methods"] = Json::array();
  report["ellipse"] = Json::array();
  for (const char* method : kMethods) {
    for (const Index cells : size.mesh_cells) {
      report["methods"].push_back(solve({cells, "solved", kMethodsRatio, method}));
    }
    for (const Index cells : size.ellipse_cells) {
      const Json result = runner.solve(
          fmt::format("{}-ellipse-{}", method, cells), scenes / "ellipse.toml",
          {fmt::format("grid.cells=[{},{}]", cells, cells / 2), MeshPoint::method_override(method)});
      Json row;  // what there is without an exact answer
      for (const char* key : {"method", "moment_ratio", "cells", "certificate", "slip_direction",
                              "operator_applications", "iterations", "seconds", "twist"}) {
        row[key] = result[key];
      }
      report["ellipse"].push_back(row);
    }
  }
  report["errata"] = errata(solve({size.loading_cells, "solved", kMethodsRatio, "paper"}),
                            by_method(report["ellipse"], "paper"));
  fs::copy(scenes, folder / "scenes", fs::copy_options::recursive | fs::copy_options::update_existing);
  report["gallery"] = gallery(runner, scenes, size.gallery_cells, folder);
  report["studies"] = study_results(scene_file, studies, size.study_cells, folder);
  write_json_file(folder / "report.json", report);
  return report;
}

}  // namespace slipstick::convergence
