#include "solver/newton/tangent_problem.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace slipstick::solver {
namespace {

/// Tangents are computed anew if more than these parts of the cells have changed their state, or of the
/// multipliers have changed. They cost about three iterations; nearby ones need no more iterations than new.
constexpr double kFewChanges = 0.1;
constexpr double kNearMultipliers = 0.1;
/// Reduction of the residual: kLooseReduction while states change; then kPartOfNeeded times the reduction of
/// the gap that the tolerance requires, but no less than kTightReduction.
constexpr double kLooseReduction = 0.1;
constexpr double kTightReduction = 1e-4;
constexpr double kPartOfNeeded = 0.3;
/// On rough surfaces, and for pressures, states change everywhere: while the active set changes, tight linear
/// solves are wasted. Forcing term of the inexact Newton method: eta = kDistrust sqrt(changed / free cells),
/// at most kLooseReductionOfRagged.
constexpr double kLooseReductionOfRagged = 0.2;
constexpr double kDistrust = 3.0;
/// Most iterations of one linear problem.
constexpr int kInnerIterations = 40;

}  // namespace

template <AdmissibleSet Set>
TangentProblem<Set>::TangentProblem(const NewtonState<Set>& state, InverseSymbol& symbol)
    : symbol_(symbol),
      packing_(state.packing()),
      tangents_(state.program().imposed.size()),
      constraints_(tangents_),
      r_(state.size()),
      x_(state.size()),
      d_(state.size()),
      space_(Set::kComponents, state.set().sweep()),
      extends_(kIsScalar || state.set().sweep().is_ragged()),
      extension_(extends_ ? state.op().grid() : Grid{}, Set::kComponents) {
  for (CgTangent& tangent : tangents_) tangent.resize(state.size());
}

template <AdmissibleSet Set>
void TangentProblem<Set>::linearise(const NewtonState<Set>& state, Trial& scratch) {
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

/// True if the tangents of an earlier step are near enough: few cells have changed their state in the last
/// step, and the multipliers, with them slip and stiffness, have changed little since the tangents were made.
template <AdmissibleSet Set>
bool TangentProblem<Set>::tangents_are_near(const NewtonState<Set>& state) const {
  return static_cast<double>(changed_) <= kFewChanges * static_cast<double>(space_.free.count()) &&
         (state.multipliers() - prepared_at_).norm() <= kNearMultipliers * state.multipliers().norm();
}

template <AdmissibleSet Set>
LinearTarget TangentProblem<Set>::target(double needed, long applications_left) const {
  const int iterations = static_cast<int>(std::min<long>(applications_left, kInnerIterations));
  if (!extends_) {
    const double reduction = changed_ > 0 ? kLooseReduction : kPartOfNeeded * needed;
    return {std::clamp(reduction, kTightReduction, kLooseReduction), iterations};
  }
  const double changed =
      static_cast<double>(changed_) / static_cast<double>(std::max<Index>(space_.free.count(), 1));
  const double reduction = std::max(kPartOfNeeded * needed, kDistrust * std::sqrt(changed));
  return {std::clamp(reduction, kTightReduction, kLooseReductionOfRagged), iterations};
}

/// The right-hand side -(s + stiffness q), which the tangent space projects.
template <AdmissibleSet Set>
void TangentProblem<Set>::write_residual(const NewtonState<Set>& state, const ArrayXd& q, ArrayXd& slip) {
  state.each([&](Index first, Index last) {
    const Index n = last - first;
    state.write_slip(first, last, slip);
    auto s = slip.segment(first, n);
    if (!kIsScalar) {
      s += space_.stiffness.segment(first % state.set().cells(), n).template cast<double>() *
           q.segment(first, n);
    }
    r_.segment(first, n) = -s;
  });
}

/// x = the combination of tangents with these loads, and its residual.
template <AdmissibleSet Set>
void TangentProblem<Set>::begin_with(const NewtonState<Set>& state, const Coefficients& loads, ArrayXd& Ax) {
  TangentOperator map{state.op(), space_, packing_};
  constraints_.add_with_values(preconditioner(), loads, x_);
  map.transform(x_, Ax);
  space_.free.each([&](Index first, Index last) { map.store(first, last, x_, Ax); });
  state.each(
      [&](Index first, Index last) { r_.segment(first, last - first) -= Ax.segment(first, last - first); });
}

template <AdmissibleSet Set>
CgSummary TangentProblem<Set>::solve(const NewtonState<Set>& state, const ArrayXd& q,
                                     const LinearTarget& target, const Coefficients& loads, Trial& scratch) {
  write_residual(state, q, scratch.u);
  clear(state.set().sweep(), x_);
  if (loads.size() > 0) begin_with(state, loads, scratch.u);
  const CgConstraints<MotionField> none;
  TangentOperator map{state.op(), space_, packing_};
  TangentPreconditioner inverse = preconditioner();
  return projected_cg(map, inverse, has_tangents_ ? constraints_ : none, r_,
                      {target.reduction, target.max_iterations}, work(scratch), x_);
}

template <AdmissibleSet Set>
bool TangentProblem<Set>::restore_loads(const NewtonState<Set>& state, ArrayXd& trial) const {
  if (!has_tangents_) return false;
  Coefficients x = Coefficients::Zero(state.balance().count());
  const auto tangents = constraints_.tangents();
  std::array<const CgTangent*, kMaxConditions> directions{};
  std::ranges::transform(tangents, directions.begin(), [](const CgTangent& tangent) { return &tangent; });
  if (!state.balance().template solve_along<CgTangent>(trial, std::span(directions).first(tangents.size()),
                                                       x))
    return false;
  state.each([&](Index first, Index last) {
    for (std::size_t k = 0; k < tangents.size(); ++k) {
      trial.segment(first, last - first) +=
          x[static_cast<Index>(k)] * tangents[k].segment(first, last - first).template cast<double>();
    }
  });
  return true;
}

template class TangentProblem<FrictionDiscs>;
template class TangentProblem<PositivePressures>;

}  // namespace slipstick::solver
