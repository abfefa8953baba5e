#pragma once

#include <algorithm>
#include <concepts>
#include <span>
#include <utility>

#include "solver/elasticity/elasticity.hpp"
#include "solver/grid/grid_transfer.hpp"
#include "solver/grid/own_rows.hpp"
#include "solver/newton/natural_map_newton.hpp"

namespace slipstick::solver {

/// The result of a nested solve on its finest grid. The displacement may be zero outside the contact cells.
struct NestedSummary {
  NewtonSummary newton;
  Eigen::ArrayXd field;         ///< q or p
  Eigen::ArrayXd displacement;  ///< K q
  Eigen::ArrayXd slip;          ///< K q + g - multipliers c
  std::vector<GridWork> grids;  ///< coarsest first
  double part = 1.0;            ///< contact cells, or candidates for them, over all cells of the finest grid
  Safeguards safeguards;        ///< of all grids
};

/// A coarse grid's answer need not be better than its mesh: gap over energy of the order of (h/a)^2.
inline double coarse_tolerance(const Grid& grid) {
  const double mirrored = grid.quadrant ? 4.0 : 1.0;
  return 1.0 / (mirrored * static_cast<double>(grid.cells()));
}

/// Coarse tractions are solved to this part of their first gap, which is about the error of prolongation:
/// a smaller one would not spare the next grid a step. Pressures are not, since they decide which cells are in contact.
constexpr double kPartOfFirstGap = 0.01;

/// A problem on one grid, for solve_nested().
template <class Problem>
concept NestedProblem = requires(Problem problem, const Grid& grid, LinearOperator& op, NestedSummary& summary) {
  { problem.kernel() } -> std::same_as<BlockKernel>;                       // of its operator
  { problem.parities() } -> std::convertible_to<std::span<const Parity>>;  // of its field's components
  { problem.admissible() } -> AdmissibleSet;
  { problem.program(op) } -> std::same_as<ConvexProgram>;  // refers to the problem's own fields
  { problem.packing() } -> std::same_as<Packing&>;         // of these, and of the set, from then on
  { problem.start() } -> std::same_as<Eigen::ArrayXd>;     // known in full
  { problem.guess() } -> std::same_as<Eigen::ArrayXd>;     // near the answer; empty: by coarser grids
  {problem.keep_own_rows()};                               // which are enough once it has been coarsened
  { problem.coarsened(grid) } -> std::same_as<Problem>;    // on the coarse grid
  // From the coarse grid's answer, whose field has been prolonged: candidates for contact cells, or a field
  // nearer to the fine grid's answer:
  {problem.predict(problem, summary.newton, summary.field)};
  // True if other cells are in contact; then these have become candidates:
  { problem.missed_contact_cells(op, summary, 0.0) } -> std::same_as<bool>;
};

/// Solves on one grid, starting at the result's field. The result's fields are packed by problem.packing().
template <NestedProblem Problem>
void solve_on_grid(const Elasticity& elasticity, const Grid& grid, Problem& problem, const Coefficients& multipliers,
                   NewtonOptions options, bool guessed, const OnCellsKnown& on_cells_known, NestedSummary& result) {
  const auto operators = elasticity.make_all(grid, problem.kernel());
  LinearOperator& op = *operators->op;
  int iterations = 0;
  options.least_iterations = guessed ? 1 : 0;
  do {
    const ConvexProgram program = problem.program(op);
    Packing& packing = problem.packing();
    result.part = static_cast<double>(packing.cells().size()) / static_cast<double>(grid.cells());
    if (on_cells_known) on_cells_known(result.part);
    const auto admissible = problem.admissible();
    result.field = packing.packed(result.field);
    result.newton = minimise(admissible, program, op, *operators->symbol, packing, result.field, multipliers, options);
    result.safeguards += result.newton.safeguards;
    iterations += result.newton.iterations;
    result.slip = std::move(result.newton.slip);
    result.displacement = std::move(result.newton.displacement);
  } while (problem.missed_contact_cells(op, result, options.tolerance));
  result.grids.push_back({grid.n1, grid.n2, op.applications(), iterations, result.newton.gap});
}

/// 1. The first field is the guess, or start() on the coarsest grid that can_coarsen() allows.
/// 2. Solve there, to a tolerance of the order of the mesh's error.
/// 3. Prolong the change from start(), which is exact on every grid, to the next finer grid, and what
///    predict() takes from it; again from 2, on the finest grid to the given tolerance.
/// 4. If cells that are no candidates turn out to be in contact, add them and solve again on that grid.
///
/// The result's field is known in this rank's rows; slip and displacement are packed.
template <NestedProblem Problem>
NestedSummary solve_on_grids(const Elasticity& elasticity, const Grid& grid, Problem& problem,
                             const NewtonOptions& options, const OnCellsKnown& on_cells_known = {}) {
  NestedSummary result;
  Coefficients multipliers;
  result.field = problem.guess();
  const bool guessed = result.field.size() > 0;
  if (!guessed) result.field = problem.start();
  result.field = in_own_rows(grid, std::move(result.field));
  if (!guessed && can_coarsen(grid)) {
    const Grid coarse = coarser(grid);
    NewtonOptions coarse_options = options;
    coarse_options.tolerance = std::max(options.tolerance, coarse_tolerance(coarse));
    if (problem.parities().size() > 1) coarse_options.part_of_first_gap = kPartOfFirstGap;
    coarse_options.refine_multipliers = false;
    coarse_options.progress = nullptr;
    Problem on_coarse = problem.coarsened(coarse);
    const Eigen::ArrayXd start = on_coarse.start();
    NestedSummary below = solve_on_grids(elasticity, coarse, on_coarse, coarse_options);
    result.grids = std::move(below.grids);
    result.safeguards = below.safeguards;
    share_rows(coarse, below.field);
    if (below.field.isFinite().all()) {
      const Eigen::ArrayXd change = prolong_to(grid, coarse, below.field - start, problem.parities());
      in_own_rows(grid, change.size(), [&](Index first, Index count) {
        result.field.segment(first, count) += change.segment(first, count);
      });
      problem.predict(on_coarse, below.newton, result.field);
    }
    multipliers = below.newton.multipliers;
  }
  problem.keep_own_rows();

  solve_on_grid(elasticity, grid, problem, multipliers, options, guessed, on_cells_known, result);
  result.field = problem.packing().unpacked(result.field);
  return result;
}

/// solve_on_grids(), then, once operators and workspaces are freed, field and slip are made whole; the
/// displacement is known in this rank's rows.
template <NestedProblem Problem>
NestedSummary solve_nested(const Elasticity& elasticity, const Grid& grid, Problem& problem,
                           const NewtonOptions& options, const OnCellsKnown& on_cells_known) {
  NestedSummary result = solve_on_grids(elasticity, grid, problem, options, on_cells_known);
  for (Eigen::ArrayXd* const field : {&result.slip, &result.displacement}) *field = problem.packing().unpacked(*field);
  for (Eigen::ArrayXd* const field : {&result.field, &result.slip}) share_rows(grid, *field);
  return result;
}

}  // namespace slipstick::solver
