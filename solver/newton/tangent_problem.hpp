#pragma once

#include <Eigen/Core>
#include <vector>

#include "solver/newton/conjugate_gradients.hpp"
#include "solver/newton/newton_state.hpp"
#include "solver/newton/tangent_space.hpp"

namespace slipstick::solver {

/// How far a linear problem is worth solving.
struct LinearTarget {
  double reduction;  ///< of the residual
  int max_iterations;
};

/// The linear problem of a Newton step: with the state that the natural map gives to every cell, the change
/// of the field in the tangent space that takes the slip away, by conjugate gradients. Trials are made after
/// it: until then it works in their memory. Compiled for both sets.
template <AdmissibleSet Set>
class TangentProblem {
 public:
  using ArrayXd = Eigen::ArrayXd;

  /// symbol: of the preconditioner; it is not owned.
  TangentProblem(const NewtonState<Set>& state, InverseSymbol& symbol);

  /// Fixes the cells' states, and makes the tangents of the conditions or takes those of an earlier step.
  void linearise(const NewtonState<Set>& state, Trial& scratch);
  /// What the next step needs. wanted: the part that is to be left of the gap; applications_left: one at
  /// least.
  LinearTarget target(double wanted, long applications_left) const;

  /// loads: of the solution; empty: none.
  CgSummary solve(const NewtonState<Set>& state, const ArrayXd& q, const LinearTarget& target,
                  const Coefficients& loads, Trial& scratch);
  const ArrayXd& solution() const { return x_; }

  /// Whether the conditions' tangents can be used: a solution keeps the loads then.
  bool has_tangents() const { return has_tangents_; }
  /// Tangents are made anew before they are used again.
  void forget_tangents() { has_tangents_ = false; }
  /// Restores the loads of the projected trial along the tangents; false if that is not possible near by.
  bool restore_loads(const NewtonState<Set>& state, ArrayXd& trial) const;
  /// See Extension; of scalars. Overwrites the residual.
  void hand_on(const NewtonState<Set>& state, ArrayXd& trial) {
    extension_.hand_on(state.packing(), space_.f1, trial, d_, r_);
  }

 private:
  static constexpr bool kIsScalar = NewtonState<Set>::kIsScalar;

  TangentPreconditioner preconditioner() {
    return {symbol_, space_, packing_, extends_ ? &extension_ : nullptr};
  }
  CgWorkspace work(Trial& scratch) { return {d_, scratch.u, scratch.q}; }
  bool tangents_are_near(const NewtonState<Set>& state) const;
  void write_residual(const NewtonState<Set>& state, const ArrayXd& q, ArrayXd& slip);
  void begin_with(const NewtonState<Set>& state, const Coefficients& loads, ArrayXd& Ax);

  InverseSymbol& symbol_;
  Packing& packing_;
  std::vector<CgTangent> tangents_;
  CgConstraints<MotionField> constraints_;
  ArrayXd r_, x_, d_;  ///< residual, solution, direction
  TangentSpace space_;
  bool extends_;  ///< pressures beyond their free cells, tractions beyond a ragged contact
  Extension extension_;
  Coefficients prepared_at_;  ///< the multipliers that the tangents were made at
  Index changed_ = 0;         ///< cells whose state the last linearisation changed
  bool has_tangents_ = false;
};

extern template class TangentProblem<FrictionDiscs>;
extern template class TangentProblem<PositivePressures>;

}  // namespace slipstick::solver
