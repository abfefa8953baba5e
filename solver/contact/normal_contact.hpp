#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "solver/contact/certificate.hpp"
#include "solver/elasticity/elasticity.hpp"
#include "solver/newton/safeguards.hpp"

namespace slipstick::solver {

/// Frictionless contact under a given load: minimise p.Kp/2 + p.h over p >= 0 with a given sum of p. One
/// consistent set of units; u3 = K33 p.
struct NormalProblem {
  const Eigen::ArrayXd& gap;  ///< undeformed gap h of each cell; infinite where the bodies cannot touch
  double total_pressure;      ///< load over cell area
  Eigen::ArrayXd guess = {};  ///< a pressure near the answer; empty: found from coarser grids
};

struct NormalOptions {
  double tolerance = 1e-10;     ///< on the complementarity gap
  bool refine_approach = true;  ///< to the tolerance, by a few more applications if necessary
  long max_applications = 2000;
  Progress progress = {};  ///< on the finest grid
  OnCellsKnown on_cells_known = {};
};

struct NormalSolution {
  Status status = Status::not_converged;
  std::string message;      ///< why it did not converge; empty if it did
  Eigen::ArrayXd pressure;  ///< one value a cell
  double approach = 0.0;    ///< u3 + h where the bodies touch
  /// (energy - least possible energy) / (p.Kp/2) is at most this: sum over p of the gap left open above its minimum.
  double complementarity = 0.0;
  double load_error = 0.0;  ///< relative
  int iterations = 0;
  std::vector<GridWork> grids = {};  ///< work done, coarsest grid first
  Safeguards safeguards = {};        ///< on all grids
  double part = 1.0;                 ///< candidates for contact over all cells
};

/// The undeformed gap on a coarse grid. A coarse cell can touch if half of its area can, and has the mean gap
/// of that area.
Eigen::ArrayXd coarsened_gap(const Grid& coarse, const Grid& grid, const Eigen::ArrayXd& gap);

/// 1. Nested grids, from the coarsest up (nested_iteration.hpp), or from a guess.
/// 2. Candidates for contact cells, from the coarse grid's pressure and opening.
/// 3. Newton's method on the natural map p = max(0, p - rho (K p + h - approach)) (natural_map_newton.hpp),
///    until complementarity gap and load balance hold.
/// 4. If another cell opens less than the candidates, more candidates, and again from 3.
///
/// Throws std::invalid_argument for a load that is not positive or a gap that is nowhere finite or NaN.
NormalSolution solve_normal_contact(const Elasticity& elasticity, const Grid& grid, const NormalProblem& problem,
                                    const NormalOptions& options = {});

}  // namespace slipstick::solver
