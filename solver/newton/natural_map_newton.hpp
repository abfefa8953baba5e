#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "solver/newton/admissible.hpp"
#include "solver/newton/conjugate_gradients.hpp"
#include "solver/newton/convex_program.hpp"
#include "solver/newton/linear_target.hpp"
#include "solver/newton/load_balance.hpp"
#include "solver/newton/safeguards.hpp"
#include "solver/newton/tangent_space.hpp"

namespace slipstick::solver {

struct NewtonOptions {
  double tolerance = 1e-8;       ///< on gap / (q.Kq/2); see is_certified()
  long max_applications = 1000;  ///< of the operator
  /// Whether the multipliers are wanted to second order, at some applications more.
  bool refine_multipliers = true;
  /// At least: a step gives each cell its state, which a start that is good enough may not have.
  int least_iterations = 0;
  std::function<void(long applications, double gap)> progress = {};
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

  NaturalMapNewton(const Set& set, const ConvexProgram& program, LinearOperator& op, InverseSymbol& symbol);

  /// Improves q, any field of the right size, until its certificate holds: the grid's own rows of it, and of
  /// the fields that the functions below return.
  /// multipliers: guesses of those of the imposed conditions, or empty.
  NewtonSummary run(ArrayXd& q, const Coefficients& multipliers, const NewtonOptions& options);

  /// At the end, before take_displacement(): u + g - multipliers c of the last q, in the cells whose set is
  /// not zero alone; zero in others.
  ArrayXd take_slip();
  /// And K q.
  ArrayXd take_displacement() { return std::move(u_); }

  long applications() const;

 private:
  using Field = Eigen::ArrayXd;
  static constexpr bool kIsScalar = Set::kComponents == 1;

  Index size() const { return Set::kComponents * set_.cells(); }
  TangentOperator tangent_operator() { return {op_, space_}; }
  TangentPreconditioner preconditioner() { return {symbol_, space_, kIsScalar ? &extension_ : nullptr}; }

  /// For the linear problem: the fields of the trial, which is made after it.
  CgWorkspace work() { return {d_, trial_u_, trial_}; }

  /// work(first, last) for the values of the cells that may carry something, and the sum of what it returns.
  template <typename Work>
  void each(const Work& work) const;
  /// For the cells of the grid's own rows.
  template <typename Work>
  void each_own(const Work& work) const;
  template <typename Work>
  double sum(const Work& work) const;

  void enter_admissible_set(ArrayXd& q);
  double energy(const ArrayXd& q, const ArrayXd& u) const;
  void write_slip(ArrayXd& s) const;
  void descend(const ArrayXd& q, double length, ArrayXd& y) const;
  bool find_state(const ArrayXd& q);
  double relative_gap(const ArrayXd& q);
  bool is_certified(double tolerance) const;
  void linearise();
  bool tangents_are_near() const;
  void write_residual(const ArrayXd& q);
  bool solve_linear(const ArrayXd& q, const LinearTarget& target, const Coefficients& loads = {});
  Coefficients jump_loads(const ArrayXd& q);
  double least_energy_at(const ArrayXd& q) const;
  bool accept_trial(ArrayXd& q);
  void write_trial(const ArrayXd& q, double length);
  bool take_newton_step(ArrayXd& q, const LinearTarget& target);
  bool restore_along_tangents();
  bool restore_along_conditions();
  bool take_gradient_step(ArrayXd& q);
  bool refine(const ArrayXd& q, double tolerance, NewtonSummary& summary);
  NewtonSummary stop(const ArrayXd& q, const NewtonOptions& options, NewtonSummary& summary,
                     const std::string& why);

  const Set& set_;
  const ConvexProgram& program_;
  LinearOperator& op_;
  InverseSymbol& symbol_;
  std::array<double, 2> mean_;
  double rho_;
  std::vector<CgTangent> tangents_;
  CgConstraints<MotionField> constraints_;
  Field r_, x_, d_;  ///< of the linear problem: residual, solution, direction
  TangentSpace space_;
  Extension extension_;  ///< of scalars
  LoadBalance<Set> balance_;
  std::vector<const MotionField*> c_;  ///< of the imposed conditions
  ArrayXd u_, y_, trial_, trial_u_;
  Coefficients multipliers_;  ///< of the imposed conditions
  double energy_ = 0.0;       ///< of q
  double elastic_ = 0.0;      ///< its q.u/2, as relative_gap() found it,
  double gap_ = 0.0;          ///< and its gap
  Safeguards safeguards_;     ///< of this run
  Coefficients prepared_at_;  ///< the multipliers that the tangents were made at
  Index changed_ = 0;
  bool has_tangents_ = false;  ///< whether the constraints can be used
  bool energy_fell_ = false;   ///< in the last step, by more than its rounding
};

extern template class NaturalMapNewton<FrictionDiscs>;
extern template class NaturalMapNewton<PositivePressures>;

}  // namespace slipstick::solver
