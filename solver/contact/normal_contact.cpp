#include "solver/contact/normal_contact.hpp"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "solver/grid/own_rows.hpp"
#include "solver/newton/nested_iteration.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

constexpr std::array<Parity, 1> kPressureParities{{{1, 1}}};

/// The normal problem on one grid, as solve_nested() asks for it.
class PressureOnGrid {
 public:
  /// reachable: 1 where the bodies can touch; height: the undeformed gap there, 0 elsewhere.
  PressureOnGrid(const Grid& grid, ArrayXd reachable, ArrayXd height, double total_pressure,
                 ArrayXd guess = {})
      : grid_(grid),
        approach_(grid, 1.0),
        reachable_(std::move(reachable)),
        height_(std::move(height)),
        total_pressure_(total_pressure),
        guess_(std::move(guess)) {}

  static BlockKernel kernel() { return normal_kernel(); }
  static std::span<const Parity> parities() { return kPressureParities; }
  PositivePressures admissible() const { return PositivePressures(grid_, reachable_); }
  ArrayXd start() const { return ArrayXd::Zero(reachable_.size()); }
  ArrayXd guess() const { return guess_; }
  void keep_own_rows() {
    reachable_ = in_own_rows(grid_, std::move(reachable_));
    height_ = in_own_rows(grid_, std::move(height_));
  }
  ConvexProgram program(LinearOperator&) const {
    return {.g = &height_, .imposed = {{&approach_, total_pressure_}}};
  }

  /// A coarse cell can touch where half of it can, at the mean height of that part.
  PressureOnGrid coarsened(const Grid& coarse) const {
    const ArrayXd part = restrict_to(coarse, grid_, reachable_);
    const ArrayXd height = restrict_to(coarse, grid_, height_);
    const ArrayXd reachable = (part >= std::min(0.5, part.maxCoeff())).cast<double>();
    return {coarse, reachable, (reachable > 0.0).select(height / part.max(0.25 * part.maxCoeff()), 0.0),
            total_pressure_ * grid_.cell_area() / coarse.cell_area()};
  }

 private:
  Grid grid_;
  MotionField approach_;
  ArrayXd reachable_;
  ArrayXd height_;
  double total_pressure_;
  ArrayXd guess_;
};

void require_valid(const NormalProblem& problem, const Grid& grid) {
  if (problem.gap.size() != grid.cells()) throw std::invalid_argument("the gap is not one value a cell");
  if (!(problem.total_pressure > 0.0) || !std::isfinite(problem.total_pressure)) {
    throw std::invalid_argument(fmt::format("normal load {}: allowed: positive", problem.total_pressure));
  }
  if (!problem.gap.isFinite().any() || problem.gap.isNaN().any()) {
    throw std::invalid_argument("the gap is nowhere finite, or not a number");
  }
}

NormalSolution find_normal_contact(const Elasticity& elasticity, const Grid& grid,
                                   const NormalProblem& problem, const NormalOptions& options) {
  PressureOnGrid contact(grid, problem.gap.isFinite().cast<double>(),
                         problem.gap.isFinite().select(problem.gap, 0.0), problem.total_pressure,
                         problem.guess);
  const NewtonOptions newton{.tolerance = options.tolerance,
                             .max_applications = options.max_applications,
                             .refine_multipliers = options.refine_approach,
                             .progress = options.progress};
  NestedSummary nested = solve_nested(elasticity, grid, std::move(contact), newton);
  NormalSolution solution;
  solution.status = nested.newton.converged ? Status::converged : Status::not_converged;
  if (!nested.newton.converged) {
    solution.message = fmt::format("{}: complementarity gap {:.3g}, asked for {:.3g}", nested.newton.message,
                                   nested.newton.gap, options.tolerance);
  }
  solution.pressure = std::move(nested.field);
  solution.approach = nested.newton.multipliers.size() > 0 ? nested.newton.multipliers[0] : std::nan("");
  solution.complementarity = nested.newton.gap;
  solution.load_error = std::abs(solution.pressure.sum() / problem.total_pressure - 1.0);
  solution.iterations = nested.newton.iterations;
  solution.grids = std::move(nested.grids);
  solution.safeguards = nested.safeguards;
  return solution;
}

}  // namespace

NormalSolution solve_normal_contact(const Elasticity& elasticity, const Grid& grid,
                                    const NormalProblem& problem, const NormalOptions& options) {
  require_valid(problem, grid);
  // From a guess no other solve starts again.
  if (problem.guess.size() > 0) return find_normal_contact(elasticity, grid, problem, options);
  CacheKey key = elasticity.key("pressure", grid);
  key.add({problem.gap.data(), static_cast<std::size_t>(problem.gap.size())}).add(problem.total_pressure);
  key.add(options.tolerance).add(options.max_applications).add(options.refine_approach);
  const Cached<NormalSolution> solution(
      elasticity.usable_cache(), std::move(key),
      [&] {
        return std::make_unique<NormalSolution>(find_normal_contact(elasticity, grid, problem, options));
      },
      sizeof(NormalSolution) + sizeof(double) * static_cast<double>(grid.cells()));
  return *solution;
}

}  // namespace slipstick::solver
