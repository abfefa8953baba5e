#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "solver/cache/solve_cache.hpp"
#include "solver/elasticity/inverse_symbol.hpp"
#include "solver/elasticity/linear_operator.hpp"

namespace slipstick::solver {

struct GridOperators;

/// How displacements follow from tractions on whatever grid a method asks for: the elastic law and the way to
/// evaluate its operators.
struct Elasticity {
  SharedLaw law;
  OperatorKind kind = OperatorKind::dcfft;
  int threads = 1;
  bool diagonal = false;                   ///< see OperatorOptions; of the tangential operator
  bool at_edge = false;                    ///< whether the contact may reach the grid's edge
  std::uint64_t rounding_seed = 0;         ///< 0: rounded to nearest; else at random
  std::shared_ptr<SolveCache> cache = {};  ///< for operators that are needed again; empty: none

  /// The cache; none under random rounding, where an operator made again is another one.
  std::shared_ptr<SolveCache> usable_cache() const;
  /// A key of these displacements on a grid.
  CacheKey key(const char* what, const Grid& grid) const;

  /// Memory on this rank, in bytes: of an operator, and of that, its preconditioner and Newton's workspaces.
  /// part: of the grid's cells that Newton's method looks at.
  double operator_bytes(const Grid& grid, const BlockKernel& kernel) const;
  double newton_bytes(const Grid& grid, const BlockKernel& kernel, double part = 1.0) const;

  /// An operator that has not been applied yet.
  Cached<LinearOperator> make(const Grid& grid, const BlockKernel& kernel) const;
  Cached<GridOperators> make_all(const Grid& grid, const BlockKernel& kernel) const;
};

/// One grid's operator and its preconditioner.
struct GridOperators {
  GridOperators(const Elasticity& elasticity, const Grid& grid, const BlockKernel& kernel);

  std::unique_ptr<LinearOperator> op;
  std::unique_ptr<InverseSymbol> symbol;
};

/// Told which part of the finest grid's cells Newton's method looks at, before it begins there; it may throw.
using OnCellsKnown = std::function<void(double part)>;

/// Applications on all grids, in those of the last, finest one: each weighs by its cells.
double finest_grid_applications(const std::vector<GridWork>& grids);

}  // namespace slipstick::solver
