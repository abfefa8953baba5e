#pragma once

#include "solver/contact/tangential_problem.hpp"
#include "solver/elasticity/elasticity.hpp"
#include "solver/newton/safeguards.hpp"

namespace slipstick::solver {

struct CoulombOptions {
  double tolerance = 1e-8;  ///< on gap / (q.Kq/2), the certificate
  long max_applications = 5000;
  bool refine_motion = true;  ///< to the tolerance, by a few more applications if necessary
  Progress progress = {};     ///< on the finest grid
  OnCellsKnown on_cells_known = {};
};

/// Coulomb's law in every cell, as the minimum of the elastic energy q.Kq/2 + g.q over the friction discs
/// |q| <= mu p with the imposed loads c_k.q = load_k:
///
/// 1. g: displacements by the pressure, less K times the tractions of the state before.
/// 2. Nested grids, from the coarsest up (nested_iteration.hpp); coarse loads are scaled to the same part of
///    the limit load.
/// 3. On each grid, Newton's method on the natural map (natural_map_newton.hpp), which stops on the
///    certificate, never on change.
/// 4. The multipliers of the loads are the motions; their error is of second order in the tractions' error.
///
/// Throws std::invalid_argument for a problem that require_valid() rejects. A failure of the iteration is a
/// status with its reason.
TangentialSolution solve_by_coulomb_method(const Elasticity& elasticity, const Grid& grid, TangentialProblem problem,
                                           const CoulombOptions& options = {});

}  // namespace slipstick::solver
