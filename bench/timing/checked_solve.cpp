#include "bench/timing/checked_solve.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "convergence/results/exact_result.hpp"
#include "convergence/runs/path_uncertainty.hpp"

namespace slipstick::bench {
namespace {

using solver::PressureModel;
using solver::Scene;

/// Twice what was seen on 16 to 1,024 cells along a side at moment ratios from 0.1 to 0.99 (and hence right):
/// - of the tractions 1.1 over the cells and the moment ratio, since their error sits at the edges and is the
///   same at any load. A looser tolerance adds its root, as the gap bounds their error's square;
/// - of the twist 2.4 over the squared cells, and where slip ring or stick area are a few cells wide the next
/// order too. With Hertz's pressure taken at the centres it is the error of the contact's area, counted in
/// cells. A looser tolerance adds four times itself, or its root by the paper's method, which has no such
///   bound.
constexpr double kTractionErrorTimesCells = 2.2;
constexpr double kTwistErrorTimesCellsSquared = 5.0;
constexpr double kTwistErrorOfCentresTimesCellsSquared = 50.0;
constexpr double kTwistErrorTimesCellsCubed = 400.0;
constexpr double kTwistErrorOverTolerance = 8.0;

double twist_bound(const Scene& scene, double cells) {
  const double second = scene.contact.pressure == PressureModel::hertz ? kTwistErrorOfCentresTimesCellsSquared
                                                                       : kTwistErrorTimesCellsSquared;
  const double iteration = scene.solver.method == solver::Method::paper
                               ? std::sqrt(scene.solver.tolerance)
                               : kTwistErrorOverTolerance * scene.solver.tolerance;
  return (second + kTwistErrorTimesCellsCubed / cells) / (cells * cells) + iteration;
}

std::string error_above_bound(const Scene& scene, double moment_ratio, const convergence::Errors& errors) {
  const auto cells = static_cast<double>(std::min(scene.grid.cells[0], scene.grid.cells[1]));
  const double traction =
      kTractionErrorTimesCells / (cells * std::abs(moment_ratio)) + std::sqrt(scene.solver.tolerance);
  if (!(errors.traction.at_centres.l2 <= traction)) {
    return fmt::format("traction error {:.3g} above {:.3g}", errors.traction.at_centres.l2, traction);
  }
  const double twist = twist_bound(scene, cells);
  if (!(std::abs(errors.twist) <= twist)) {
    return fmt::format("twist error {:.3g} above {:.3g}", errors.twist, twist);
  }
  return "";
}

}  // namespace

CheckedSolution solve_and_check(const Scene& scene) {
  const convergence::Oracle exact = convergence::require_oracle(scene);
  CheckedSolution checked{.solution = convergence::solve_with_path(scene), .errors = {}, .invalid_reason = {}};
  checked.errors = convergence::compare(checked.solution, exact);
  checked.invalid_reason = invalid_reason(scene, checked.solution, checked.errors);
  return checked;
}

std::string invalid_reason(const Scene& scene, const solver::Solution& solution, const convergence::Errors& errors) {
  if (solution.status != solver::Status::converged) return solution.message;
  const double gap = solution.certificate.gap;
  if (scene.solver.method != solver::Method::paper && !(gap <= scene.solver.tolerance)) {
    return fmt::format("certificate {:.3g} above the tolerance {:.3g}", gap, scene.solver.tolerance);
  }
  return error_above_bound(scene, solution.moment / solution.moment_limit, errors);
}

}  // namespace slipstick::bench
