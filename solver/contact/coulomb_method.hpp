#pragma once

#include "solver/contact/tangential_problem.hpp"
#include "solver/elasticity/elasticity.hpp"
#include "solver/newton/progress.hpp"

namespace slipstick::solver {

struct CoulombOptions {
  double tolerance = 1e-8;  ///< on gap / (q.Kq/2), the certificate
  long max_applications = 5000;
  bool refine_motion = true;  ///< to the tolerance, at some applications more where it needs be
  Progress progress = {};     ///< on the finest grid
  OnCellsKnown on_cells_known = {};
};

/// Coulomb's law in every cell, certified: minimises the elastic energy over the friction discs under the
/// moment, or the twist, by Newton's method on the natural map (natural_map_newton.hpp), from the coarsest
/// grid up: each grid is solved to its own discretisation error and starts the next finer one. Stops on the
/// certificate, never on change. The twist's error is of second order in that of the tractions.
///
/// Throws std::invalid_argument for a problem that require_valid() refuses. Everything that the numbers do is
/// a status with its reason.
TangentialSolution solve_by_coulomb_method(const Elasticity& elasticity, const Grid& grid,
                                           TangentialProblem problem, const CoulombOptions& options = {});

}  // namespace slipstick::solver
