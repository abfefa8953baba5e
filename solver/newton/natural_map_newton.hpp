#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>

#include "solver/newton/newton_state.hpp"
#include "solver/newton/progress.hpp"
#include "solver/newton/tangent_problem.hpp"

namespace slipstick::solver {

struct NewtonOptions {
  double tolerance = 1e-8;       ///< on gap / (q.Kq/2); see is_certified()
  double part_of_first_gap = 0;  ///< of the field that it begins with: as good as the tolerance
  long max_applications = 1000;  ///< of the operator
  /// Whether the multipliers are wanted to the tolerance, at some applications more where they need be.
  bool refine_multipliers = true;
  /// At least: a step gives each cell its state, which a start that is good enough may not have.
  int least_iterations = 0;
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
/// Each step fixes the state that the natural map gives to every cell and solves the linear problem in the
/// tangent space by conjugate gradients. The step's end
/// is projected onto the admissible set and the loads restored along the tangent fields (K + stiffness)^-1 c,
/// which disturb the multipliers alone. Near gross slip these fields bring the loads back to second order
/// only, and cannot make up for what cells bring that jump onto their circles; where they fail the linear
/// problem is solved again with the jumps' loads taken out of it. Pressures that would turn negative are
/// handed on to cells beside them. Where the energy is less before the step's end than there, the step ends
/// at its least, which costs nothing: the set is convex. Where it does not fall at all the step is halved;
/// where even that fails, steps of the projected gradient take over, which always descend.
///
/// Compiled for both sets.
template <AdmissibleSet Set>
class NaturalMapNewton {
 public:
  using ArrayXd = Eigen::ArrayXd;

  /// packing: of all fields, the cells whose set is not zero alone.
  NaturalMapNewton(const Set& set, const ConvexProgram& program, LinearOperator& op, InverseSymbol& symbol,
                   Packing& packing);

  /// Improves q, any field of the right size, until its certificate holds: the grid's own rows of it, and of
  /// the fields that the functions below return.
  /// multipliers: guesses of those of the imposed conditions, or empty.
  NewtonSummary run(ArrayXd& q, const Coefficients& multipliers, const NewtonOptions& options);

  /// At the end, before take_displacement(): u + g - multipliers c of the last q, in the cells whose set is
  /// not zero alone; zero in others.
  ArrayXd take_slip() { return state_.take_slip(); }
  /// At the end: K q.
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
