#pragma once

#include "solver/scene/scene.hpp"
#include "solver/solution.hpp"

namespace slipstick::solver {

/// How far a solution is from the solution of the friction law everywhere in the contact, not only at the
/// centres of the cells. Both problems have the same loads and the solution's own friction bound f, constant
/// in each cell.
///
/// With the slip s(x) of the tractions q, constant in cells, the integral of q.s + f |s| is a sum of
/// non-negative terms for any rigid motion, and bounds energy(q) - energy(q*) and |q - q*|_K^2/2, where q*
/// solves the continuous problem: docs/theory.md. The integral is a sum over points of the cells, so the
/// bound holds up to `quadrature_error`, which is estimated, not proven.
struct ContinuumGap {
  double gap;               ///< the integral over `energy`
  double energy;            ///< J, q.Kq/2 with displacements integrated over the cells
  double quadrature_error;  ///< of gap and energy, relative to `energy`: an estimate, by another rule
};

/// By s at 3 x 3 points of each cell: one application of the operator on a grid whose cells are a third as
/// long, 9 times as many. Throws std::invalid_argument for a history, for tractions that the pressure changes
/// by K13 and K23, and for several ranks.
ContinuumGap continuum_gap(const Scene& scene, const Solution& solution);

}  // namespace slipstick::solver
