#include "solver/newton/natural_map_newton.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "solver/newton/newton_state.hpp"
#include "solver/newton/tangent_problem.hpp"

namespace slipstick::solver {
namespace {

/// rho over the mean of the inverse symbol. A smaller rho changes fewer states per step. For tractions 0.1 to
/// 0.3 makes no difference, 1 overshoots. Many small contact spots need a small rho: a rough sphere on
/// 1,608 x 1,608 cells at half its limit takes 6 steps with 0.1 and 7 with 0.05, on 804 x 804 cells 8 with
/// 0.2.
constexpr double kRho = 0.2;
constexpr double kRhoOfSpots = 0.1;
constexpr double kRhoOfPressure = 0.1;
/// Most iterations of the linear problem that refines the multipliers at the end; each reduces their error by
/// about kRefined.
constexpr int kRefiningIterations = 2;
constexpr double kRefined = 5.0;
/// Safety factor: the error of multipliers falls about as the gap does.
constexpr double kMultiplierSafety = 10.0;
/// Steps without a lower gap that end the run; fewer if the gap is certified over energy_before.
constexpr int kIdleSteps = 8;
constexpr int kIdleStepsOfEnough = 2;
/// Most halvings of a Newton step, and of a gradient step of length rho.
constexpr int kMaxHalvings = 6;
constexpr int kMaxGradientHalvings = 30;

double mean_of(const std::array<double, 2>& pair) { return 0.5 * (pair[0] + pair[1]); }

template <AdmissibleSet Set>
double rho_for(const Set& set) {
  if (Set::kComponents == 1) return kRhoOfPressure;
  return set.sweep().is_ragged() ? kRhoOfSpots : kRho;
}

NewtonSummary fail(NewtonSummary& summary, const std::string& why) {
  summary.message = why;
  return summary;
}

template <AdmissibleSet Set>
class NaturalMapNewton {
 public:
  using ArrayXd = Eigen::ArrayXd;

  /// packing: of all fields, the contact cells.
  NaturalMapNewton(const Set& set, const ConvexProgram& program, LinearOperator& op, InverseSymbol& symbol,
                   Packing& packing)
      : state_(set, program, op, packing, rho_for(set) * mean_of(symbol.diagonal())),
        linear_(state_, symbol),
        trial_{ArrayXd(state_.size()), ArrayXd(state_.size())} {
    clear(set.sweep(), trial_.q);
  }

  NewtonSummary run(ArrayXd& q, const Coefficients& multipliers, const NewtonOptions& options) {
    NewtonSummary summary;
    safeguards_ = {};
    linear_.discard_tangents();
    state_.enter(q, multipliers);
    if (options.least_iterations > 0) linear_.expect_states(state_, q, trial_);
    double best_gap = std::numeric_limits<double>::infinity();
    double wanted = options.tolerance;
    int idle_steps = 0;
    bool settled = false;  // the last step has not lowered the energy by more than its rounding
    for (;; ++summary.iterations) {
      const Coefficients last = state_.multipliers();
      const double last_gap = summary.gap;
      if (!state_.find_multipliers(q))
        return fail(summary, "no multiplier restores the load: it is not finite, or at its limit");
      summary.gap = state_.relative_gap(q, trial_.u);
      summary.multipliers = state_.multipliers();
      summary.safeguards = safeguards_;
      if (options.progress) options.progress(state_.op().applications(), summary.gap);
      if (std::isnan(summary.gap)) return fail(summary, "an elastic energy that is not a positive number");
      if (summary.iterations == 0 && std::isfinite(summary.gap))
        wanted = std::max(wanted, options.part_of_first_gap * summary.gap);
      if (summary.gap <= wanted && summary.iterations >= options.least_iterations &&
          (!options.refine_multipliers ||
           refine(q, options.tolerance, multiplier_error(last, summary.gap / last_gap), summary))) {
        summary.converged = true;
        return summary;
      }
      if (settled && summary.gap > options.tolerance && state_.is_certified(options.tolerance, trial_.u)) {
        return stop(q, options, summary, "rounding");
      }
      const bool enough = state_.program().energy_before > 0.0 && state_.is_certified(options.tolerance, trial_.u);
      const bool progress = summary.gap < (enough ? 0.5 : 1.0) * best_gap;
      idle_steps = progress ? 0 : idle_steps + 1;
      best_gap = std::min(best_gap, summary.gap);
      if (idle_steps > (enough ? kIdleStepsOfEnough : kIdleSteps))
        return stop(q, options, summary, "rounding: no further progress");
      const long left = options.max_applications - state_.op().applications();
      if (left <= 0) {
        return stop(q, options, summary,
                    fmt::format("no convergence within {} operator applications", options.max_applications));
      }
      linear_.linearise(state_, trial_);
      const LinearTarget target = linear_.target(options.tolerance / summary.gap, left, idle_steps == 0);
      const double before = state_.energy();
      if (!take_newton_step(q, target) && !take_gradient_step(q)) {
        return stop(q, options, summary, "rounding: no step lowers the energy");
      }
      settled = !(state_.energy() < before - kEnergyRounding * std::abs(before));
    }
  }

  void take_fields(NewtonSummary& summary) {
    summary.slip = state_.take_slip();
    summary.displacement = state_.take_displacement();
  }

 private:
  static constexpr bool kIsScalar = Set::kComponents == 1;

  bool take_newton_step(ArrayXd& q, const LinearTarget& target) {
    if (!solve_linear(q, target)) return false;
    write_trial(q, 1.0);
    bool restored = linear_.restore_loads(state_, trial_.q);
    if (!kIsScalar && !restored && linear_.has_tangents() && state_.balance().count() > 0) {
      ++safeguards_.second_solves;
      if (!solve_linear(q, target, -jump_loads(q))) return false;
      write_trial(q, 1.0);
      restored = linear_.restore_loads(state_, trial_.q);
    }
    for (int halvings = 0; halvings <= kMaxHalvings; ++halvings) {
      if (halvings > 0) {
        ++safeguards_.halvings;
        write_trial(q, std::ldexp(1.0, -halvings));
        restored = linear_.restore_loads(state_, trial_.q);
      }
      if ((restored || restore_along_conditions()) && state_.accept(q, trial_, safeguards_)) return true;
    }
    return false;
  }

  bool take_gradient_step(ArrayXd& q) {
    for (int halvings = 0; halvings <= kMaxGradientHalvings; halvings += 2) {
      const double length = std::ldexp(state_.rho(), -halvings);
      clear(state_.set().sweep(), trial_.q);
      state_.descend(q, length, trial_.q);
      Coefficients x = length * state_.multipliers();
      if (!state_.balance().solve(trial_.q, x)) continue;
      state_.balance().add(x, trial_.q);
      if (!state_.accept(q, trial_, safeguards_)) continue;
      ++safeguards_.gradient_steps;
      return true;
    }
    return false;
  }

  /// loads: of the solution; empty: none. False where conjugate gradients broke down.
  bool solve_linear(const ArrayXd& q, const LinearTarget& target, const Coefficients& loads = {}) {
    const CgSummary solved = linear_.solve(state_, q, target, loads, trial_);
    if (!solved.broke_down()) return true;
    safeguards_ += {.breakdowns = 1, .breakdown = solved.message()};
    return false;
  }

  /// trial = q + length (linear solution + jumps).
  void write_trial(const ArrayXd& q, double length) {
    clear(state_.set().sweep(), trial_.q);
    state_.each([&](Index first, Index last) {
      trial_.q.segment(first, last - first) = linear_.solution().segment(first, last - first);
    });
    state_.set().add_jump(state_.y(), q, trial_.q);
    state_.each([&](Index first, Index last) {
      auto trial = trial_.q.segment(first, last - first);
      trial = q.segment(first, last - first) + length * trial;
    });
    if constexpr (kIsScalar) linear_.redistribute(state_, trial_.q);
  }

  /// The loads of the cells that jump onto the face of their set.
  Coefficients jump_loads(const ArrayXd& q) {
    clear(state_.set().sweep(), trial_.q);
    state_.set().add_jump(state_.y(), q, trial_.q);
    Coefficients loads(state_.balance().count());
    for (Index k = 0; k < loads.size(); ++k) {
      const MotionField& c = *state_.program().imposed[static_cast<std::size_t>(k)].c;
      loads[k] =
          state_.sum([&](Index first, Index last) { return c.dot(first, trial_.q.segment(first, last - first)); });
    }
    return loads;
  }

  bool restore_along_conditions() {
    Coefficients x = Coefficients::Zero(state_.balance().count());
    if (!state_.balance().solve(trial_.q, x)) return false;
    state_.balance().add(x, trial_.q);
    return true;
  }

  /// The largest relative error of the multipliers: their last change times the last reduction of the gap.
  /// Multipliers of zero loads are skipped, unless they follow from earlier states.
  double multiplier_error(const Coefficients& last, double part_of_gap) const {
    const Coefficients& now = state_.multipliers();
    double largest = 0.0;
    for (Index k = 0; k < now.size(); ++k) {
      const bool loaded = state_.program().imposed[static_cast<std::size_t>(k)].load != 0.0;
      if (!loaded && state_.program().energy_before == 0.0) continue;
      const double error = kMultiplierSafety * part_of_gap * std::abs(now[k] - last[k]);
      const double part = error == 0.0 ? 0.0 : error / std::abs(now[k]);
      largest = part <= largest ? largest : part;  // keeps NaN
    }
    return largest;
  }

  /// If the relative error of the multipliers exceeds the tolerance, replaces them by the multipliers of a
  /// Newton step that keeps the loads, which are right to second order. False if the gap is then above the
  /// tolerance, so that another step is due.
  bool refine(const ArrayXd& q, double tolerance, double error, NewtonSummary& summary) {
    if (error <= tolerance) return true;
    linear_.linearise(state_, trial_);
    if (!linear_.has_tangents() || state_.balance().count() == 0) return true;
    const int iterations = error <= kRefined * tolerance ? 1 : kRefiningIterations;
    const CgSummary step = linear_.solve(state_, q, {0.0, iterations}, {}, trial_);
    if (step.broke_down()) return true;
    const Coefficients first_order = state_.multipliers();
    state_.set_multipliers(first_order - step.multipliers);
    const double gap = state_.relative_gap(q, trial_.u);
    if (gap <= tolerance) {
      summary.gap = gap;
      summary.multipliers = state_.multipliers();
      return true;
    }
    state_.set_multipliers(first_order);
    linear_.discard_tangents();
    return false;
  }

  /// Ends at an admissible state that no step improves: above the tolerance, or certified within rounding.
  NewtonSummary stop(const ArrayXd& q, const NewtonOptions& options, NewtonSummary& summary, const std::string& why) {
    if (options.refine_multipliers) refine(q, summary.gap, std::numeric_limits<double>::infinity(), summary);
    summary.gap = state_.relative_gap(q, trial_.u);
    summary.converged = state_.is_certified(options.tolerance, trial_.u);
    return summary.converged ? summary : fail(summary, why);
  }

  NewtonState<Set> state_;
  TangentProblem<Set> linear_;
  Trial trial_;
  Safeguards safeguards_;  ///< of this run
};

}  // namespace

template <AdmissibleSet Set>
NewtonSummary minimise(const Set& set, const ConvexProgram& program, LinearOperator& op, InverseSymbol& symbol,
                       Packing& packing, Eigen::ArrayXd& q, const Coefficients& multipliers,
                       const NewtonOptions& options) {
  NaturalMapNewton<Set> newton(set, program, op, symbol, packing);
  NewtonSummary summary = newton.run(q, multipliers, options);
  newton.take_fields(summary);
  return summary;
}

template NewtonSummary minimise(const FrictionDiscs&, const ConvexProgram&, LinearOperator&, InverseSymbol&, Packing&,
                                Eigen::ArrayXd&, const Coefficients&, const NewtonOptions&);
template NewtonSummary minimise(const PositivePressures&, const ConvexProgram&, LinearOperator&, InverseSymbol&,
                                Packing&, Eigen::ArrayXd&, const Coefficients&, const NewtonOptions&);

}  // namespace slipstick::solver
