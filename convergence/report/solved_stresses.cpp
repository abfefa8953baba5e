#include "convergence/report/solved_stresses.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "convergence/oracle/oracle.hpp"
#include "solver/solve.hpp"
#include "solver/stresses/subsurface_stresses.hpp"

namespace slipstick::convergence {
namespace {

using Tensor = std::array<double, solver::kStresses>;

double largest_shear(const Tensor& stress) {
  const Eigen::Vector3d principal = solver::principal_stresses(stress);
  return 0.5 * (principal[2] - principal[0]);
}

constexpr const char* kMeasures[] = {"von_mises", "shear"};

/// The stresses along one axis, in rows.
Json plane(std::size_t axis, const std::vector<Tensor>& stresses, std::size_t columns) {
  Json json{{"plane", axis == 0 ? "x1-x3" : "x2-x3"}};
  for (std::size_t k = 0; k < stresses.size(); ++k) {
    for (const char* measure : kMeasures) {
      if (k % columns == 0) json[measure].push_back(Json::array());
      json[measure].back().push_back(measure == kMeasures[0] ? solver::von_mises(stresses[k])
                                                             : largest_shear(stresses[k]));
    }
  }
  return json;
}

}  // namespace

std::vector<RunSpec> stress_runs(const std::filesystem::path& scene, const std::vector<solver::Index>& cells) {
  std::vector<RunSpec> runs;
  for (const solver::Index across : cells) {
    runs.push_back({.scene = scene,
                    .overrides = {fmt::format("grid.cells=[{0},{0}]", across), "contact.friction=0.5"},
                    .stress_error = true});
  }
  return runs;
}

Json solved_stresses(const std::filesystem::path& file, const Json& map, const std::vector<Json>& results) {
  constexpr solver::Index kCells = 64;
  const solver::Scene scene = solver::read_scene(file, stress_runs(file, {kCells}).front().overrides);
  const Oracle exact = *find_oracle(scene).oracle;
  const solver::Solution solution = solver::solve(scene);
  const double spacing = number_at(map, "spacing") * exact.contact_radius;
  const std::size_t rows = map["von_mises"].size(), columns = map["von_mises"][0].size();
  Json planes = Json::array(), errors = Json::array();
  for (const std::size_t axis : {0, 1}) {
    std::vector<std::array<double, 3>> points;
    for (std::size_t k = columns; k < rows * columns; ++k) {
      points.push_back({0.0, 0.0, spacing * static_cast<double>(k / columns)});
      points.back()[axis] = -spacing * static_cast<double>(k % columns);
    }
    std::vector<Tensor> stresses;
    for (const auto& at : stresses_at(solution, scene.lower.poisson_ratio, solver::Body::lower, points)) {
      Tensor& stress = stresses.emplace_back();
      for (std::size_t c = 0; c < stress.size(); ++c)
        stress[c] = (at.by_pressure[c] + at.by_shear[c]) / exact.normal.peak_pressure;
    }
    planes.push_back(plane(axis, stresses, columns));
  }
  for (const Json& result : results)
    errors.push_back({{"cells", result.at("cells")}, {"stress_error", result.at("stress_error")}});
  return {{"cells", scene.grid.cells}, {"planes", planes}, {"errors", errors}};
}

}  // namespace slipstick::convergence
