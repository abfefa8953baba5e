#include "bench/suite/paper_scene.hpp"

#include <cmath>
#include <filesystem>

namespace slipstick::bench {

using solver::Scene;

Scene paper_scene(solver::Index cells, double moment_ratio) {
  Scene scene = solver::read_scene(std::filesystem::path(SLIPSTICK_SCENES) / "paper.toml");
  scene.grid.cells = {cells, cells};
  scene.steps[0].torsion = solver::MomentRatio{moment_ratio};
  scene.solver.method = solver::Method::coulomb;
  scene.solver.model = solver::ModelChoice::full;
  scene.contact.pressure = solver::PressureModel::solved;
  scene.solver.tolerance = 1e-8;
  scene.solver.threads = 1;
  return scene;
}

std::map<std::string, benchmark::Counter> counters(const CheckedSolution& checked) {
  const auto& [solution, errors, invalid_reason] = checked;
  const std::map<std::string, double> values{{"twist_error", errors.twist},
                                             {"traction_error", errors.traction.at_centres.l2},
                                             {"stick_radius_error", errors.stick_radius},
                                             {"gap", solution.certificate.gap},
                                             {"applications", solution.operator_applications},
                                             {"pressure_applications", solution.pressure_applications},
                                             {"iterations", solution.iterations},
                                             {"bytes", solution.bytes}};
  std::map<std::string, benchmark::Counter> result;
  for (const auto& [name, value] : values) {
    if (std::isfinite(value)) result[name] = value;  // JSON has no NaN
  }
  return result;
}

}  // namespace slipstick::bench
