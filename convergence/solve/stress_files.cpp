#include "convergence/solve/stress_files.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "solver/input/field_file.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/units.hpp"
#include "solver/stresses/subsurface_stresses.hpp"

namespace slipstick::convergence {

using solver::InputError;

constexpr std::string_view kDepthNumber = "{depth}";

std::string StressFiles::name(std::size_t depth) const {
  std::string name = file;
  const auto at = name.find(kDepthNumber);
  return at == std::string::npos ? name : name.replace(at, kDepthNumber.size(), std::to_string(depth + 1));
}

void StressFiles::read_depths(const solver::Scene& scene) {
  solver::require_field_format(file, "--stresses");
  for (const std::string& word : depth_words) {
    const auto in_metres = solver::parse_number(word, 0);
    const double depth = in_metres ? *in_metres : solver::Units().read(word, "m").value_or(NAN);
    if (!(depth > 0.0) || !std::isfinite(depth))
      throw InputError("--depths " + word,
                       "allowed: a depth above zero in m, or with its unit, as \"20 um\"");
    depths.push_back(depth);
  }
  if (depths.size() > 1 && file.find(kDepthNumber) == std::string::npos) {
    throw InputError("--stresses " + file,
                     "allowed: a name with {depth}, since each of several depths has its own file");
  }
  if (!solver::is_bare(scene)) {
    throw InputError(scene.source.string(),
                     "has a layer; allowed with --stresses: half-spaces without a layer between or on them");
  }
  if (scene.solver.model == solver::ModelChoice::exact)
    throw InputError("--stresses " + file,
                     "allowed: a solve on a grid; slipstick exact --at has exact stresses");
}

Json write_stresses(const StressFiles& files, const solver::Scene& scene, const solver::Solution& solution) {
  const bool upper = std::isinf(scene.lower.young_modulus);
  const solver::Grid& grid = solution.grid;
  solver::SubsurfaceStresses stresses(solution, (upper ? scene.upper : scene.lower).poisson_ratio,
                                      upper ? solver::Body::upper : solver::Body::lower, solution.threads);
  solver::LargestStresses largest;
  for (std::size_t d = 0; d < files.depths.size(); ++d) {
    const solver::StressPlane plane = stresses.at(files.depths[d]);
    largest.include(plane, grid);
    std::vector<solver::Column> columns{{"x1", solver::cell_x1(grid)}, {"x2", solver::cell_x2(grid)}};
    constexpr std::array kNames{"s11", "s22", "s33", "s12", "s13", "s23"};
    for (std::size_t a = 0; a < kNames.size(); ++a) columns.push_back({kNames[a], plane.stress[a]});
    columns.push_back({"von_mises", solver::von_mises(plane.stress)});
    solver::write_fields(files.name(d), grid, columns, Eigen::ArrayXd::Ones(grid.cells()));
  }
  const auto json = [](const solver::LargestStresses::Place& place) {
    return Json{{"value", place.value}, {"at", place.at}};
  };
  Json found{{"body", upper ? "upper" : "lower"},
             {"depths", files.depths},
             {"von_mises", json(largest.von_mises)},
             {"tresca", json(largest.tresca)},
             {"tension", json(largest.tension)}};
  if (const auto yield = (upper ? scene.upper : scene.lower).yield_stress)
    found["yield_ratio"] = largest.von_mises.value / *yield;
  return found;
}

std::string stresses_text(const Json& found) {
  const Json& largest = found["von_mises"];
  const auto metres = [&](std::size_t axis) { return number_text(largest["at"][axis].get<double>()); };
  std::string text = text_line(
      "stresses", fmt::format("von Mises {} Pa at most in the {} body, at x1 = {} m, x2 = {} m, depth {} m",
                              number_text(largest["value"].get<double>()), found["body"].get<std::string>(),
                              metres(0), metres(1), metres(2)));
  if (found.contains("yield_ratio"))
    text += text_line(
        "", fmt::format("{} times the yield stress", number_text(found["yield_ratio"].get<double>())));
  return text;
}

}  // namespace slipstick::convergence
