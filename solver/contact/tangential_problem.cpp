#include "solver/contact/tangential_problem.hpp"

#include <fmt/core.h>

#include <stdexcept>

#include "solver/grid/sweep.hpp"

namespace slipstick::solver {

double moment_limit(const Grid& grid, const Eigen::ArrayXd& friction_bound) {
  const Eigen::ArrayXd x2 = Eigen::ArrayXd::NullaryExpr(grid.n2, [&](Index j) { return grid.x2(j); });
  return Sweep::whole(grid).sum<double>([&](Index first, Index last, double& sum) {
    const double x1 = grid.x1(first / grid.n2);
    sum += (friction_bound.segment(first, last - first) * (x1 * x1 + x2.square()).sqrt()).sum();
  });
}

LimitLoad limit_of(const TangentialProblem& problem, const Grid& grid) {
  if (problem.force || problem.displacement) {
    ImposedLoads loads;
    if (problem.force) {
      loads[0] = (*problem.force)[0];
      loads[1] = (*problem.force)[1];
    }
    loads[2] = problem.moment;
    return find_limit(grid, problem.friction_bound, loads);
  }
  const double moment = problem.moment.value_or(0.0);
  const double factor = moment == 0.0 ? std::numeric_limits<double>::infinity()
                                      : moment_limit(grid, problem.friction_bound) / std::abs(moment);
  return {.factor = factor, .carried = factor, .sliding = {0.0, 0.0, 1.0 / moment}, .centre = {{0.0, 0.0}}};
}

void require_valid(const TangentialProblem& problem, const Grid& grid) {
  const auto& bound = problem.friction_bound;
  if (!(bound >= 0.0).all() || !bound.isFinite().all()) {
    throw std::invalid_argument("friction bound mu p: allowed: finite, zero or positive in every cell");
  }
  if (problem.moment.has_value() == problem.twist.has_value()) {
    throw std::invalid_argument("torsion: allowed: either a moment or a twist");
  }
  if (problem.force && problem.displacement) {
    throw std::invalid_argument("translation: allowed: either forces or displacements");
  }
  if (problem.twist && !std::isfinite(*problem.twist)) throw std::invalid_argument("twist: allowed: finite");
  for (const auto& pair : {problem.force, problem.displacement}) {
    if (pair && !(std::isfinite((*pair)[0]) && std::isfinite((*pair)[1]))) {
      throw std::invalid_argument("force or displacement: allowed: finite");
    }
  }
  if (problem.moment && !std::isfinite(*problem.moment)) {
    throw std::invalid_argument("moment: gross slip; allowed: finite");
  }
  const double factor = problem.limit_factor ? *problem.limit_factor : limit_of(problem, grid).factor;
  if (!(factor > 1.0)) {
    throw std::invalid_argument(
        fmt::format("gross slip: the contact carries {} times these loads (over the cell area); allowed: less than it "
                    "carries",
                    factor));
  }
}

TangentialProblem reduced(TangentialProblem& problem, const Reduction& part) {
  const double images = part.quadrant() ? 4.0 : 1.0;
  TangentialProblem on_part{.friction_bound = part.restricted(std::move(problem.friction_bound)),
                            .initial_displacement = part.restricted(std::move(problem.initial_displacement)),
                            .moment = problem.moment,
                            .twist = problem.twist,
                            .force = problem.force,
                            .displacement = problem.displacement,
                            .start = part.restricted(std::move(problem.start)),
                            .energy_before = problem.energy_before / images,
                            .limit_factor = problem.limit_factor};
  if (on_part.moment) *on_part.moment /= images;
  return on_part;
}

}  // namespace slipstick::solver
