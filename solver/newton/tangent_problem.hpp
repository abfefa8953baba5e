#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "solver/newton/conjugate_gradients.hpp"
#include "solver/newton/newton_state.hpp"
#include "solver/newton/tangent_space.hpp"

namespace slipstick::solver {

/// When to stop the linear problem.
struct LinearTarget {
  double reduction;  ///< of the residual
  int max_iterations;
  double known_step = 0.0;  ///< CgOptions
};

/// Tangents are computed anew if more than these parts of the cells have changed their state, or of the
/// multipliers have changed. They cost about three iterations; nearby ones need no more iterations than new.
inline constexpr double kFewChanges = 0.1;
inline constexpr double kNearMultipliers = 0.1;
/// Reduction of the residual: kLooseReduction while states change; then kPartOfNeeded times the reduction of
/// the gap that the tolerance requires, but no less than kTightReduction.
inline constexpr double kLooseReduction = 0.1;
inline constexpr double kTightReduction = 1e-4;
inline constexpr double kPartOfNeeded = 0.3;
/// On rough surfaces, and for pressures, states change everywhere: while the active set changes, tight linear
/// solves are wasted. Forcing term of the inexact Newton method: eta = kDistrust sqrt(changed / free cells)
/// for pressures, for tractions with kDistrustOfTractions, at most kLooseReductionOfRagged.
inline constexpr double kLooseReductionOfRagged = 0.2;
inline constexpr double kDistrust = 3.0;
inline constexpr double kDistrustOfTractions = 1.5;
/// While more than this part of the cells change their state, the first direction of conjugate gradients,
/// times its usual length, replaces them: the states that it assumes are wrong, and the length, 0.7 to 0.9,
/// costs as much as the next states.
inline constexpr double kManyChanges = 0.005;
inline constexpr double kUsualStep = 0.8;
/// Most iterations of one linear problem.
inline constexpr int kInnerIterations = 40;

/// The linear problem of a Newton step: the change of the field in the tangent space of the cells' states that removes
/// the slip, by conjugate gradients. It uses the memory of the Trial, which is written afterwards.
template <AdmissibleSet Set>
class TangentProblem {
 public:
  using ArrayXd = Eigen::ArrayXd;

  /// symbol: of the preconditioner; it is not owned.
  TangentProblem(const NewtonState<Set>& state, InverseSymbol& symbol)
      : symbol_(symbol),
        packing_(state.packing()),
        tangents_(state.program().imposed.size()),
        constraints_(tangents_),
        r_(state.size()),
        x_(state.size()),
        d_(state.size()),
        space_(Set::kComponents, state.set().sweep()),
        extends_(kIsScalar || state.set().sweep().is_ragged()),
        extension_(extends_ ? state.op().grid() : Grid{}, Set::kComponents, symbol.idle_memory()) {
    for (CgTangent& tangent : tangents_) tangent.resize(state.size());
  }

  /// Fixes the cells' states, and computes the tangents of the conditions, or keeps an earlier step's.
  void linearise(const NewtonState<Set>& state, Trial& scratch) {
    changed_ = state.set().linearise(state.y(), state.rho(), symbol_.diagonal(), space_);
    if (extends_) extension_.prepare(space_, packing_);
    TangentPreconditioner map = preconditioner();
    const CgWorkspace fields = work(scratch);
    if (has_tangents_ && tangents_are_near(state)) {
      has_tangents_ = constraints_.restrict_tangents(map, state.set().sweep(), fields.y);
      return;
    }
    const std::vector<Condition>& imposed = state.program().imposed;
    std::array<const MotionField*, kMaxConditions> conditions{};
    std::ranges::transform(imposed, conditions.begin(), &Condition::c);
    has_tangents_ = constraints_.prepare(map, std::span(conditions).first(imposed.size()), fields.d, fields.y);
    prepared_at_ = state.multipliers();
  }

  /// The cells' states in a guess: the next linearise() counts those that differ.
  void expect_states(const NewtonState<Set>& state, const ArrayXd& guess, Trial& scratch) {
    constexpr double kBeyondCircle = 1.0 + 1e-9;
    scratch.u = kBeyondCircle * guess;
    state.set().linearise(scratch.u, state.rho(), symbol_.diagonal(), space_);
  }

  /// needed: tolerance over gap; applications_left: at least one; progress: the last step has lowered the gap.
  LinearTarget target(double needed, long applications_left, bool progress) const {
    const int iterations = static_cast<int>(std::min<long>(applications_left, kInnerIterations));
    if (!extends_) {
      const double reduction = changed_ > 0 ? kLooseReduction : kPartOfNeeded * needed;
      return {std::clamp(reduction, kTightReduction, kLooseReduction), iterations};
    }
    const double changed = static_cast<double>(changed_) / static_cast<double>(std::max<Index>(space_.free.count(), 1));
    const double known_step = progress && changed > kManyChanges ? kUsualStep : 0.0;
    const double reduction =
        std::max(kPartOfNeeded * needed, (kIsScalar ? kDistrust : kDistrustOfTractions) * std::sqrt(changed));
    return {std::clamp(reduction, kTightReduction, kLooseReductionOfRagged), iterations, known_step};
  }

  /// loads: of the solution; empty: none.
  CgSummary solve(const NewtonState<Set>& state, const ArrayXd& q, const LinearTarget& target,
                  const Coefficients& loads, Trial& scratch) {
    write_residual(state, q, scratch.u);
    clear(state.set().sweep(), x_);
    if (loads.size() > 0) begin_with(state, loads, scratch.u);
    const CgConstraints<MotionField> none;
    TangentOperator map{state.op(), space_, packing_};
    TangentPreconditioner inverse = preconditioner();
    return projected_cg(map, inverse, has_tangents_ ? constraints_ : none, r_,
                        {target.reduction, target.max_iterations, target.known_step}, work(scratch), x_);
  }

  const ArrayXd& solution() const { return x_; }

  /// True if the conditions' tangents can be used: then a solution keeps the loads.
  bool has_tangents() const { return has_tangents_; }
  void discard_tangents() { has_tangents_ = false; }

  /// Restores the loads of the projected trial along the tangents; false if no solution is nearby.
  bool restore_loads(const NewtonState<Set>& state, ArrayXd& trial) const {
    if (!has_tangents_) return false;
    Coefficients x = Coefficients::Zero(state.balance().count());
    const auto tangents = constraints_.tangents();
    std::array<const CgTangent*, kMaxConditions> directions{};
    std::ranges::transform(tangents, directions.begin(), [](const CgTangent& tangent) { return &tangent; });
    if (!state.balance().template solve_along<CgTangent>(trial, std::span(directions).first(tangents.size()), x))
      return false;
    state.each([&](Index first, Index last) {
      for (std::size_t k = 0; k < tangents.size(); ++k) {
        trial.segment(first, last - first) +=
            x[static_cast<Index>(k)] * tangents[k].segment(first, last - first).template cast<double>();
      }
    });
    return true;
  }

  /// Extension::redistribute() for scalars. Overwrites the residual.
  void redistribute(const NewtonState<Set>& state, ArrayXd& trial) {
    extension_.redistribute(state.packing(), space_.f1, trial, d_, r_);
  }

 private:
  static constexpr bool kIsScalar = NewtonState<Set>::kIsScalar;

  TangentPreconditioner preconditioner() { return {symbol_, space_, packing_, extends_ ? &extension_ : nullptr}; }

  CgWorkspace work(Trial& scratch) { return {d_, scratch.u, scratch.q}; }

  /// True if the tangents of an earlier step are near enough: few cells have changed their state in the last step, and
  /// the multipliers, with them slip and stiffness, have changed little since the tangents were made.
  bool tangents_are_near(const NewtonState<Set>& state) const {
    return static_cast<double>(changed_) <= kFewChanges * static_cast<double>(space_.free.count()) &&
           (state.multipliers() - prepared_at_).norm() <= kNearMultipliers * state.multipliers().norm();
  }

  /// The right-hand side -(s + stiffness q), which the tangent space projects.
  void write_residual(const NewtonState<Set>& state, const ArrayXd& q, ArrayXd& slip) {
    state.each([&](Index first, Index last) {
      const Index n = last - first;
      state.write_slip(first, last, slip);
      auto s = slip.segment(first, n);
      if (!kIsScalar) {
        s += space_.stiffness.segment(first % state.set().cells(), n).template cast<double>() * q.segment(first, n);
      }
      r_.segment(first, n) = -s;
    });
  }

  /// x = the combination of tangents with these loads, and its residual.
  void begin_with(const NewtonState<Set>& state, const Coefficients& loads, ArrayXd& Ax) {
    TangentOperator map{state.op(), space_, packing_};
    constraints_.add_with_values(preconditioner(), loads, x_);
    map.transform(x_, Ax);
    space_.free.each([&](Index first, Index last) { map.store(first, last, x_, Ax); });
    state.each([&](Index first, Index last) { r_.segment(first, last - first) -= Ax.segment(first, last - first); });
  }

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

}  // namespace slipstick::solver
