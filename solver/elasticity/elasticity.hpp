#pragma once

#include <cfenv>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "solver/cache/solve_cache.hpp"
#include "solver/elasticity/inverse_symbol.hpp"
#include "solver/elasticity/linear_operator.hpp"

namespace slipstick::solver {

struct GridOperators;

/// The elastic law and the way to evaluate it: makes operators and preconditioners for any grid.
struct Elasticity {
  SharedLaw law;
  OperatorKind kind = OperatorKind::dcfft;
  int threads = 1;
  bool diagonal = false;                   ///< see OperatorOptions; of the tangential operator
  bool at_edge = false;                    ///< true if the contact may reach the grid's edge
  std::uint64_t rounding_seed = 0;         ///< 0: rounded to nearest; else at random
  std::shared_ptr<SolveCache> cache = {};  ///< for operators that are needed again; empty: none

  /// The cache; none under random rounding, where each operator draws its own errors.
  std::shared_ptr<SolveCache> usable_cache() const;
  /// A key of these displacements on a grid.
  CacheKey key(const char* what, const Grid& grid) const;

  /// Memory on this rank, in bytes: of an operator; of an operator, its preconditioner and Newton's
  /// workspaces. part: contact cells over all cells.
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

/// Restores this thread's rounding direction at the end; optionally sets another one first.
class KeptRounding {
 public:
  KeptRounding() : found_(std::fegetround()) {}
  explicit KeptRounding(int direction) : KeptRounding() { std::fesetround(direction); }
  ~KeptRounding() { std::fesetround(found_); }
  KeptRounding(const KeptRounding&) = delete;
  KeptRounding& operator=(const KeptRounding&) = delete;

 private:
  int found_;
};

/// Called with contact cells over all cells of the finest grid before Newton's method starts there; it may
/// throw, for lack of memory.
using OnCellsKnown = std::function<void(double part)>;

/// Applications on all grids in units of the finest grid's: each is weighted by its cells.
double finest_grid_applications(const std::vector<GridWork>& grids);

}  // namespace slipstick::solver
