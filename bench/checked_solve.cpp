#include "bench/checked_solve.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "convergence/exact_result.hpp"

namespace slipstick::bench {
namespace {

using solver::Scene;
using solver::Solution;

/// On 64 to 1,024 cells along a side and to a tight tolerance, the tractions' error is at most 1.1 over the
/// cells, the twist's 2.4 over their square (it is of second order): twice that is right. A looser tolerance
/// adds its root to the tractions, as the gap bounds their error's square, and itself to the twist, or its
/// root too by the paper's method, which has no such bound.
constexpr double kTractionErrorTimesCells = 2.2;
constexpr double kTwistErrorTimesCellsSquared = 5.0;

std::string objection_to(const Scene& scene, const Solution& solution) {
  if (solution.status != solver::Status::converged) return solution.message;
  const double gap = solution.certificate.gap;
  if (scene.method == solver::Method::coulomb && !(gap <= scene.tolerance)) {
    return fmt::format("certificate {:.3g} above the tolerance {:.3g}", gap, scene.tolerance);
  }
  return "";
}

std::string objection_to(const Scene& scene, const convergence::Errors& errors) {
  const auto cells = static_cast<double>(std::min(scene.cells[0], scene.cells[1]));
  const double root = std::sqrt(scene.tolerance);
  const double traction = kTractionErrorTimesCells / cells + root;
  const double twist = kTwistErrorTimesCellsSquared / (cells * cells) +
                       (scene.method == solver::Method::coulomb ? scene.tolerance : root);
  if (!(errors.traction.at_centres.l2 <= traction)) {
    return fmt::format("traction error {:.3g} above {:.3g}", errors.traction.at_centres.l2, traction);
  }
  if (!(std::abs(errors.twist) <= twist)) {
    return fmt::format("twist error {:.3g} above {:.3g}", errors.twist, twist);
  }
  return "";
}

}  // namespace

Scene shipped_scene(const std::string& name) {
  return solver::read_scene(std::filesystem::path(SLIPSTICK_SCENES) / (name + ".toml"));
}

Scene paper_scene(solver::Index cells, double moment_ratio) {
  Scene scene = shipped_scene("paper");
  scene.cells = {cells, cells};
  scene.steps[0].torsion = {.moment_ratio = moment_ratio, .moment = {}, .twist = {}};
  scene.method = solver::Method::coulomb;
  scene.model = solver::ModelChoice::full;
  scene.pressure = solver::PressureModel::solved;
  scene.tolerance = 1e-8;
  scene.threads = 1;
  return scene;
}

CheckedSolution solve_and_check(const Scene& scene) {
  const convergence::Oracle exact = convergence::require_oracle(scene);
  CheckedSolution checked{.solution = solver::solve(scene), .errors = {}, .objection = {}};
  checked.errors = convergence::compare(checked.solution, exact);
  checked.objection = objection_to(scene, checked.solution);
  if (checked.objection.empty()) checked.objection = objection_to(scene, checked.errors);
  return checked;
}

}  // namespace slipstick::bench
