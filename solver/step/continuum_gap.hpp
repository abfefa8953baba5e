#pragma once

#include <memory>

#include "solver/cache/solve_cache.hpp"
#include "solver/scene/scene.hpp"
#include "solver/solution.hpp"

namespace slipstick::solver {

/// How far a solution is from the solution of the friction law everywhere in the contact, not only at the centres of
/// the cells. Both problems have the same loads and the solution's own friction bound f, constant in each cell.
///
/// With the slip s(x) of the tractions q, constant in cells, and any part r(x) of it, the integral of
/// q.(s - r) + f |s - r|, and half the squared dual norm of r, bound energy(q) - energy(q*) and
/// |q - q*|_K^2/2, where q* solves the continuous problem: docs/theory.md. r is the slip where cells stick: it is rough
/// there, and its dual norm small. For coated bodies, and bodies that end, r = 0. The integrals are sums over points of
/// the cells, so the bound holds up to `quadrature_error`, which is estimated, not proven.
struct ContinuumGap {
  double gap;               ///< the bound over `energy`
  double energy;            ///< J, q.Kq/2 with displacements integrated over the cells
  double quadrature_error;  ///< of gap and energy, relative to `energy`: an estimate, by other rules
  Eigen::ArrayXd density;   ///< J/m^2: the mean of q.s + f |s| over each cell of the solution's grid
};

/// By s at 3 x 3 points of each cell: one application of the operator on a grid whose cells are a third as
/// long, 9 times as many. cache: keeps that operator for the next gap. Throws std::invalid_argument for a
/// history, for tractions that the pressure changes by K13 and K23, and for several ranks.
ContinuumGap continuum_gap(const Scene& scene, const Solution& solution, std::shared_ptr<SolveCache> cache = {});

/// How far a pressure is from the law of contact everywhere, not only at the centres of the cells.
///
/// With w(x) = (Kp)(x) + h(x) - delta of the pressures p, constant in cells, the integral of p w over the
/// places where w is positive, and half the squared dual norm of the overlap -w elsewhere, bound energy(p) -
/// energy(p*) and |p - p*|_K^2/2, where p* solves the continuous problem of the same bodies and normal load
/// and the energy is the integral of p (Kp/2 + h): docs/theory.md.
struct PressureGap {
  double gap;               ///< the bound over `energy`
  double energy;            ///< J, p.Kp/2
  double quadrature_error;  ///< of gap and energy, relative to `energy`: an estimate, by other rules
  double distance;          ///< at least |p - p*|_K, J^(1/2)
};

/// By w at 3 x 3 points of each cell of the whole grid. Throws std::invalid_argument for a pressure from a
/// file, for one that tractions change by K31 and K32, for a history and for several ranks.
PressureGap pressure_gap(const Scene& scene, const Solution& solution);

/// J: the least energy q.Kq/2 that carries the loads under the true friction bound mu p* is not smaller than the energy
/// of this solution's tractions, less its continuum gap, less this number: mu times the pressure's distance from p*
/// times a bound of |s| in the dual norm. Where the motions are imposed, twice it bounds the change of the energy to
/// both sides. Valid if the true contact lies in the circle through the farthest corner of this one's cells. Throws
/// std::invalid_argument for other laws than Coulomb's, and where bodies are coated or end.
double friction_bound_error(const Scene& scene, const Solution& solution, const PressureGap& pressure);

}  // namespace slipstick::solver
