#include "solver/contact/normal_contact.hpp"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "solver/grid/own_rows.hpp"
#include "solver/newton/nested_iteration.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

constexpr std::array<Parity, 1> kPressureParities{{{1, 1}}};

/// Candidate cells are predicted from the coarse grid: cells with a pressure there, or whose opening under
/// its displacement is below the root mean square of the overlap elsewhere. Above this fraction of the cells
/// that can touch, all of these are candidates.
constexpr double kMostOfAll = 0.7;

/// The normal problem on one grid: a NestedProblem.
class PressureOnGrid {
 public:
  using Gap = std::shared_ptr<const ArrayXd>;
  /// gap: undeformed, infinite where the bodies cannot touch.
  PressureOnGrid(const Grid& grid, Gap gap, double total_pressure, ArrayXd guess = {})
      : grid_(grid),
        approach_(grid, 1.0),
        gap_(std::move(gap)),
        reachable_(cells_where([&](Index i) { return can_touch(i); })),
        cells_(reachable_),
        total_pressure_(total_pressure),
        guess_(std::move(guess)) {}

  static BlockKernel kernel() { return normal_kernel(); }
  static std::span<const Parity> parities() { return kPressureParities; }
  PositivePressures admissible() const { return PositivePressures(packing_.cells()); }
  Packing& packing() { return packing_; }
  ArrayXd start() const { return ArrayXd::Zero(grid_.cells()); }
  ArrayXd guess() const { return guess_; }
  void keep_own_rows() {
    if (grid_.ranks.several()) gap_ = std::make_shared<const ArrayXd>(in_own_rows(grid_, *gap_));
  }
  ConvexProgram program(LinearOperator&) {
    packing_ = Packing(grid_, cells_, 1);
    heights_ = packing_.packed(*gap_);
    packed_approach_ = approach_.packed(packing_);
    return {.g = &heights_, .imposed = {{&packed_approach_, total_pressure_}}};
  }

  PressureOnGrid coarsened(const Grid& coarse) const {
    return {coarse, std::make_shared<const ArrayXd>(coarsened_gap(coarse, grid_, *gap_)),
            total_pressure_ * grid_.cell_area() / coarse.cell_area()};
  }

  /// From the opening under the coarse grid's displacement. pressure: the coarse grid's.
  void predict(PressureOnGrid& coarse, const NewtonSummary& found, const ArrayXd& pressure) {
    if (!found.converged) return;
    share_rows(coarse.grid_, coarse.displacement_);
    ArrayXd opening = prolong_to(grid_, coarse.grid_, coarse.displacement_, kPressureParities);
    opening += *gap_ - found.multipliers[0];
    const Sweep closed = cells_where([&](Index i) { return opening[i] < 0.0; });
    const double square = closed.sum<double>(
        [&](Index first, Index last, double& sum) { sum += opening.segment(first, last - first).square().sum(); });
    const double overlap = std::sqrt(square / static_cast<double>(std::max<Index>(closed.count(), 1)));
    set_candidates([&](Index i) { return can_touch(i) && (pressure[i] > 0.0 || opening[i] < overlap); });
  }

  /// True if other cells open less than the candidates, and the gap over all cells exceeds the tolerance:
  /// then the candidates are enlarged.
  bool missed_contact_cells(LinearOperator& op, NestedSummary& result, double tolerance) {
    if (!result.newton.converged || cells_.count() == reachable_.count()) {
      displacement_ = packing_.unpacked(result.displacement);
      return false;
    }
    const double energy = 0.5 * packing_.cells().sum<double>([&](Index first, Index last, double& sum) {
      const Index n = last - first;
      sum += (result.field.segment(first, n) * result.displacement.segment(first, n)).sum();
    });
    displacement_ = packing_.unpacked(result.field);
    op.apply_own(displacement_, displacement_);
    const auto lowest_of = [&](const Sweep& cells) {
      return cells
          .sum<Lowest>([&](Index first, Index last, Lowest& lowest) {
            for (Index i = first; i < last; ++i) lowest += {displacement_[i] + (*gap_)[i]};
          })
          .value;
    };
    const double lowest = lowest_of(cells_);
    const double missed = lowest - lowest_of(reachable_);
    result.newton.gap += missed * total_pressure_ / energy;
    if (!(result.newton.gap > tolerance)) {
      result.newton.converged = result.newton.gap <= tolerance;
      return false;
    }
    result.field = packing_.unpacked(result.field);
    set_candidates([&](Index i) { return packing_.place(i) >= 0 || displacement_[i] + (*gap_)[i] < lowest + missed; });
    for (ArrayXd* const field : {&displacement_, &result.slip, &result.displacement}) field->resize(0);
    return true;
  }

 private:
  bool can_touch(Index cell) const { return std::isfinite((*gap_)[cell]); }
  template <typename Contains>
  Sweep cells_where(const Contains& contains) const {
    Sweep cells(grid_);
    cells.assign(contains);
    return cells;
  }
  template <typename Contains>
  void set_candidates(const Contains& contains) {
    cells_ = cells_where(contains);
    if (static_cast<double>(cells_.count()) > kMostOfAll * static_cast<double>(reachable_.count())) cells_ = reachable_;
  }

  Grid grid_;
  MotionField approach_;
  Gap gap_;
  Sweep reachable_, cells_;  ///< cells that can touch, and the candidates among them
  double total_pressure_;
  ArrayXd guess_;
  Packing packing_;
  MotionField packed_approach_ = approach_;
  ArrayXd heights_;       ///< packed
  ArrayXd displacement_;  ///< K p in all cells, once some were no candidates
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

NormalSolution find_normal_contact(const Elasticity& elasticity, const Grid& grid, const NormalProblem& problem,
                                   const NormalOptions& options) {
  const PressureOnGrid::Gap gap(PressureOnGrid::Gap(), &problem.gap);  // not owned
  PressureOnGrid contact(grid, gap, problem.total_pressure, problem.guess);
  const NewtonOptions newton{.tolerance = options.tolerance,
                             .max_applications = options.max_applications,
                             .refine_multipliers = options.refine_approach,
                             .progress = options.progress};
  NestedSummary nested = solve_nested(elasticity, grid, contact, newton, options.on_cells_known);
  NormalSolution solution;
  solution.status = nested.newton.converged ? Status::converged : Status::not_converged;
  if (!nested.newton.converged) {
    solution.message = fmt::format("{}: complementarity gap {:.3g}, tolerance {:.3g}", nested.newton.message,
                                   nested.newton.gap, options.tolerance);
  }
  solution.pressure = std::move(nested.field);
  solution.approach = nested.newton.multipliers.size() > 0 ? nested.newton.multipliers[0] : std::nan("");
  solution.complementarity = nested.newton.gap;
  solution.load_error = std::abs(solution.pressure.sum() / problem.total_pressure - 1.0);
  solution.iterations = nested.newton.iterations;
  solution.grids = std::move(nested.grids);
  solution.safeguards = nested.safeguards;
  solution.part = nested.part;
  return solution;
}

}  // namespace

ArrayXd coarsened_gap(const Grid& coarse, const Grid& grid, const ArrayXd& gap) {
  const ArrayXd part = restrict_to(coarse, grid, gap.isFinite().cast<double>());
  const ArrayXd height = restrict_to(coarse, grid, gap.isFinite().select(gap, 0.0));
  const double most = part.maxCoeff();
  return (part >= std::min(0.5, most)).select(height / part.max(0.25 * most), INFINITY);
}

NormalSolution solve_normal_contact(const Elasticity& elasticity, const Grid& grid, const NormalProblem& problem,
                                    const NormalOptions& options) {
  require_valid(problem, grid);
  // The same guess does not come twice.
  if (problem.guess.size() > 0 || !elasticity.usable_cache())
    return find_normal_contact(elasticity, grid, problem, options);
  CacheKey key = elasticity.key("pressure", grid);
  key.add({problem.gap.data(), static_cast<std::size_t>(problem.gap.size())}).add(problem.total_pressure);
  key.add(options.tolerance).add(options.max_applications).add(options.refine_approach);
  const Cached<NormalSolution> solution(
      elasticity.usable_cache(), std::move(key),
      [&] { return std::make_unique<NormalSolution>(find_normal_contact(elasticity, grid, problem, options)); },
      sizeof(NormalSolution) + sizeof(double) * static_cast<double>(grid.cells()));
  return *solution;
}

}  // namespace slipstick::solver
