#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>

#include "solver/elasticity/inverse_symbol.hpp"
#include "solver/elasticity/linear_operator.hpp"
#include "solver/newton/admissible.hpp"
#include "solver/newton/convex_program.hpp"
#include "solver/newton/safeguards.hpp"

namespace slipstick::solver {

struct NewtonOptions {
  double tolerance = 1e-8;         ///< on gap / (q.Kq/2); see is_certified()
  double part_of_first_gap = 0;    ///< stop at this part of the first gap, if that is above the tolerance
  long max_applications = 1000;    ///< of the operator
  bool refine_multipliers = true;  ///< to the tolerance, by a few more applications if necessary
  int least_iterations = 0;        ///< 1 for guesses: a step determines the states of the cells
  Progress progress = {};
};

struct NewtonSummary {
  bool converged = false;
  std::string message;                                    ///< why not
  double gap = std::numeric_limits<double>::quiet_NaN();  ///< over q.Kq/2
  Coefficients multipliers;                               ///< of the imposed conditions
  int iterations = 0;
  Safeguards safeguards;
  Eigen::ArrayXd slip;          ///< K q + g - multipliers c in the contact cells, zero in others
  Eigen::ArrayXd displacement;  ///< K q
};

/// Semismooth Newton method on the natural map q = P(q - rho (Kq + g - multipliers c)) of a convex program
/// over a product of small sets (Hintermueller, Ito and Kunisch 2003; for friction Alart and Curnier 1991).
///
/// 1. Multipliers: c.P(q - rho s) = load with s = Kq + g - multipliers c. Stop if gap / (q.Kq/2) is below the
///    tolerance.
/// 2. Linearise: P(q - rho s) determines the state of each cell (stick, slip; contact, open).
/// 3. Solve (K + stiffness) d = -s on the tangent space of these states by conjugate gradients; for pressures
///    and many spots d is their first direction times its usual length while many states change.
/// 4. q + d is projected onto the set, and its loads restored along the tangents (K + stiffness)^-1 c. Near
///    gross slip that may fail, because cells jump onto their circles: then 3 is repeated without the loads
///    of the jumps. Negative pressures are redistributed to neighbouring cells.
/// 5. The step ends where the energy along it is least; the set is convex. If the energy does not fall the
///    step is halved, and at last replaced by a projected gradient step, which always descends. Again from 1.
///
/// Improves q, any field of the right size, until its certificate holds: this rank's rows of it. packing: of all
/// fields, the contact cells. multipliers: guesses for the imposed conditions, or empty. Compiled for both sets.
template <AdmissibleSet Set>
NewtonSummary minimise(const Set& set, const ConvexProgram& program, LinearOperator& op, InverseSymbol& symbol,
                       Packing& packing, Eigen::ArrayXd& q, const Coefficients& multipliers,
                       const NewtonOptions& options);

}  // namespace slipstick::solver
