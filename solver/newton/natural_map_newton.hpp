#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>

#include "solver/newton/newton_state.hpp"
#include "solver/newton/safeguards.hpp"
#include "solver/newton/tangent_problem.hpp"

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
};

/// Semismooth Newton method on the natural map q = P(q - rho (Kq + g - multipliers c)) of a convex program
/// over a product of small sets (Hintermueller, Ito and Kunisch 2003; for friction Alart and Curnier 1991).
///
/// 1. Multipliers: c.P(q - rho s) = load with s = Kq + g - multipliers c. Stop if gap / (q.Kq/2) is below the
///    tolerance.
/// 2. Linearise: P(q - rho s) determines the state of each cell (stick, slip; contact, open).
/// 3. Solve (K + stiffness) d = -s on the tangent space of these states by conjugate gradients.
/// 4. q + d is projected onto the set, and its loads restored along the tangents (K + stiffness)^-1 c. Near
///    gross slip that may fail, because cells jump onto their circles: then 3 is repeated without the loads
///    of the jumps. Negative pressures are redistributed to neighbouring cells.
/// 5. The step ends where the energy along it is least; the set is convex. If the energy does not fall the
///    step is halved, and at last replaced by a projected gradient step, which always descends. Again from 1.
///
/// Compiled for both sets.
template <AdmissibleSet Set>
class NaturalMapNewton {
 public:
  using ArrayXd = Eigen::ArrayXd;

  /// packing: of all fields, the contact cells.
  NaturalMapNewton(const Set& set, const ConvexProgram& program, LinearOperator& op, InverseSymbol& symbol,
                   Packing& packing);

  /// Improves q, any field of the right size, until its certificate holds: this rank's rows of it.
  /// multipliers: guesses for the imposed conditions, or empty.
  NewtonSummary run(ArrayXd& q, const Coefficients& multipliers, const NewtonOptions& options);

  /// After run(), and before take_displacement(): K q + g - multipliers c in the contact cells, zero in
  /// others.
  ArrayXd take_slip() { return state_.take_slip(); }
  /// After run(): K q.
  ArrayXd take_displacement() { return state_.take_displacement(); }

  long applications() const { return state_.op().applications(); }

 private:
  static constexpr bool kIsScalar = Set::kComponents == 1;

  bool take_newton_step(ArrayXd& q, const LinearTarget& target);
  bool take_gradient_step(ArrayXd& q);
  bool solve_linear(const ArrayXd& q, const LinearTarget& target, const Coefficients& loads = {});
  void write_trial(const ArrayXd& q, double length);
  Coefficients jump_loads(const ArrayXd& q);
  bool restore_along_conditions();
  double multiplier_error(const Coefficients& last, double part_of_gap) const;
  bool refine(const ArrayXd& q, double tolerance, double error, NewtonSummary& summary);
  NewtonSummary stop(const ArrayXd& q, const NewtonOptions& options, NewtonSummary& summary,
                     const std::string& why);

  NewtonState<Set> state_;
  TangentProblem<Set> linear_;
  Trial trial_;
  Safeguards safeguards_;  ///< of this run
};

extern template class NaturalMapNewton<FrictionDiscs>;
extern template class NaturalMapNewton<PositivePressures>;

}  // namespace slipstick::solver
