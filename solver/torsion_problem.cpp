#include "solver/torsion_problem.hpp"

#include <fmt/core.h>

#include <cmath>
#include <stdexcept>

#include "solver/certificate.hpp"

namespace slipstick::solver {

double moment_limit(const Grid& grid, const Eigen::ArrayXd& friction_bound) {
  return (friction_bound * norms(rotation_field(grid))).sum();
}

void require_valid(const TorsionProblem& problem, const Grid& grid) {
  const auto& bound = problem.friction_bound;
  if (!(bound >= 0.0).all() || !bound.isFinite().all()) {
    throw std::invalid_argument("friction bound mu p: allowed: finite, zero or positive in every cell");
  }
  if (problem.moment.has_value() == problem.twist.has_value()) {
    throw std::invalid_argument("torsion: allowed: either a moment or a twist");
  }
  const double limit = moment_limit(grid, bound);
  if (problem.moment && *problem.moment != 0.0 && !(std::abs(*problem.moment) < limit)) {
    throw std::invalid_argument(
        fmt::format("moment {} (over the cell area): gross slip; allowed: below {}", *problem.moment, limit));
  }
  if (problem.twist && !std::isfinite(*problem.twist)) throw std::invalid_argument("twist: allowed: finite");
}

}  // namespace slipstick::solver
