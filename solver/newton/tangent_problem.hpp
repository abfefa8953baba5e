#pragma once

#include <Eigen/Core>
#include <vector>

#include "solver/newton/conjugate_gradients.hpp"
#include "solver/newton/newton_state.hpp"
#include "solver/newton/tangent_space.hpp"

namespace slipstick::solver {

/// When to stop the linear problem.
struct LinearTarget {
  double reduction;  ///< of the residual
  int max_iterations;
};

/// The linear problem of a Newton step: the change of the field in the tangent space of the cells' states
/// that removes the slip, by conjugate gradients. It uses the memory of the Trial, which is written
/// afterwards. Compiled for both sets.
template <AdmissibleSet Set>
class TangentProblem {
 public:
  using ArrayXd = Eigen::ArrayXd;

  /// symbol: of the preconditioner; it is not owned.
  TangentProblem(const NewtonState<Set>& state, InverseSymbol& symbol);

  /// Fixes the cells' states, and computes the tangents of the conditions, or keeps an earlier step's.
  void linearise(const NewtonState<Set>& state, Trial& scratch);
  /// needed: tolerance over gap; applications_left: at least one.
  LinearTarget target(double needed, long applications_left) const;

  /// loads: of the solution; empty: none.
  CgSummary solve(const NewtonState<Set>& state, const ArrayXd& q, const LinearTarget& target,
                  const Coefficients& loads, Trial& scratch);
  const ArrayXd& solution() const { return x_; }

  /// True if the conditions' tangents can be used: then a solution keeps the loads.
  bool has_tangents() const { return has_tangents_; }
  void discard_tangents() { has_tangents_ = false; }
  /// Restores the loads of the projected trial along the tangents; false if no solution is nearby.
  bool restore_loads(const NewtonState<Set>& state, ArrayXd& trial) const;
  /// Extension::redistribute() for scalars. Overwrites the residual.
  void redistribute(const NewtonState<Set>& state, ArrayXd& trial) {
    extension_.redistribute(state.packing(), space_.f1, trial, d_, r_);
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
  Coefficients prepared_at_;  ///< multipliers at which the tangents were computed
  Index changed_ = 0;         ///< cells whose state changed in the last linearisation
  bool has_tangents_ = false;
};

extern template class TangentProblem<FrictionDiscs>;
extern template class TangentProblem<PositivePressures>;

}  // namespace slipstick::solver
