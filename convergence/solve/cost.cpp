#include "convergence/solve/cost.hpp"

#include <algorithm>
#include <chrono>
#include <limits>

#include "solver/elasticity/linear_operator.hpp"
#include "solver/model/make_model.hpp"

namespace slipstick::convergence {
namespace {

/// Number of timed rounds, and least seconds of a round. The quickest round counts: it is likely undisturbed
/// by other processes.
constexpr int kRounds = 7;
constexpr double kRoundSeconds = 2e-4;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Mean over the applications of one round.
double round_seconds(solver::LinearOperator& op, const Eigen::ArrayXd& in, Eigen::ArrayXd& out) {
  const auto start = std::chrono::steady_clock::now();
  int applications = 0;
  do {
    op.apply(in, out);
    ++applications;
  } while (seconds_since(start) < kRoundSeconds);
  return seconds_since(start) / applications;
}

/// Keeps the ratio of the sides.
void set_reference_cells(solver::Scene& scene) {
  const solver::Index longer = std::max(scene.grid.cells[0], scene.grid.cells[1]);
  if (longer == 0) return;  // a height map's
  for (solver::Index& cells : scene.grid.cells) {
    cells = std::max<solver::Index>(1, cells * kReferenceCells / longer);
  }
}

}  // namespace

double application_seconds(solver::Scene scene) {
  set_reference_cells(scene);
  const solver::Model model = solver::make_model(scene);
  const bool whole = model.pressure_coupling || model.forces;
  const solver::Reduction part = whole ? solver::Reduction(model.grid) : model.pressure_part;
  const auto op = solver::elasticity(scene, model, part).make(part.grid(), solver::tangential_kernel());
  const auto size = static_cast<solver::Index>(op->inputs()) * part.grid().cells();
  const Eigen::ArrayXd in = Eigen::ArrayXd::LinSpaced(size, -1.0, 1.0);
  Eigen::ArrayXd out(static_cast<solver::Index>(op->outputs()) * part.grid().cells());
  double quickest = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRounds; ++round) quickest = std::min(quickest, round_seconds(*op, in, out));
  return quickest;
}

}  // namespace slipstick::convergence
