#include "solver/newton/natural_map_newton.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// rho over the mean of the inverse symbol. Smaller is more careful about changing cells' states; between
/// 0.1 and 0.3 makes no difference to tractions, 1 overshoots; many small contact spots want it small.
constexpr double kRho = 0.2;
constexpr double kRhoOfPressure = 0.1;
/// Of the linear problem that refines the multipliers at the end; each brings them nearer by about 5.
constexpr int kRefiningIterations = 2;
constexpr int kPatience = 8;
constexpr int kPatienceOfEnough = 2;
/// Of a Newton step, and of a gradient step of length rho, before it is given up.
constexpr int kMaxHalvings = 6;
constexpr int kMaxGradientHalvings = 30;
/// A step ends where its energy is least if that is within these parts of it: closer to its end it is taken
/// in full, so that cells reach the faces of their sets.
constexpr double kLeastPart = 1e-3;
constexpr double kNearlyAll = 0.9;
/// Tangents are made anew where more than this part of the cells has changed its state, or multipliers have
/// by more than this part of them.
constexpr double kFewChanges = 1e-3;
constexpr double kNearMultipliers = 0.1;
/// Energies are compared up to their rounding.
constexpr double kEnergyRounding = 1e-13;

NewtonSummary fail(NewtonSummary& summary, const std::string& why) {
  summary.message = why;
  return summary;
}

}  // namespace

template <AdmissibleSet Set>
NaturalMapNewton<Set>::NaturalMapNewton(const Set& set, const ConvexProgram& program, LinearOperator& op,
                                        InverseSymbol& symbol)
    : set_(set),
      program_(program),
      op_(op),
      symbol_(symbol),
      mean_(symbol.diagonal()),
      rho_((kIsScalar ? kRhoOfPressure : kRho) * 0.5 * (mean_[0] + mean_[1])),
      tangents_(program.imposed.size()),
      constraints_(tangents_),
      r_(size()),
      x_(size()),
      d_(size()),
      space_(Set::kComponents, set.sweep()),
      extension_(kIsScalar ? op.grid() : Grid{}),
      balance_(set, program.imposed),
      u_(size()),
      y_(size()),
      trial_(size()),
      trial_u_(size()) {
  for (CgTangent& tangent : tangents_) tangent.resize(size());
  clear(set.sweep(), y_);
  clear(set.sweep(), trial_);
  for (const Condition& condition : program.imposed) c_.push_back(condition.c);
}

template <AdmissibleSet Set>
NewtonSummary NaturalMapNewton<Set>::run(ArrayXd& q, const Coefficients& multipliers,
                                         const NewtonOptions& options) {
  NewtonSummary summary;
  safeguards_ = {};
  has_tangents_ = false;
  multipliers_ = multipliers.size() == balance_.count() ? multipliers : Coefficients::Zero(balance_.count());
  enter_admissible_set(q);
  double best_gap = std::numeric_limits<double>::infinity();
  int without_progress = 0;
  for (;; ++summary.iterations) {
    if (!find_state(q))
      return fail(summary, "no multiplier restores the load: it is not finite, or at its limit");
    if (program_.energy_before > 0.0) energy_ = energy(q, u_);
    summary.gap = relative_gap(q);
    summary.multipliers = multipliers_;
    summary.safeguards = safeguards_;
    if (options.progress) options.progress(applications(), summary.gap);
    if (std::isnan(summary.gap)) return fail(summary, "an elastic energy that is not a positive number");
    if (summary.gap <= options.tolerance && summary.iterations >= options.least_iterations &&
        (!options.refine_multipliers || refine(q, options.tolerance, summary))) {
      summary.converged = true;
      return summary;
    }
    const bool settled = summary.iterations > 0 && !energy_fell_;
    if (settled && summary.gap > options.tolerance && is_certified(options.tolerance)) {
      return stop(q, options, summary, "rounding");
    }
    const bool enough = program_.energy_before > 0.0 && is_certified(options.tolerance);
    const bool progress = enough ? summary.gap < 0.5 * best_gap : summary.gap < best_gap || energy_fell_;
    without_progress = progress ? 0 : without_progress + 1;
    best_gap = std::min(best_gap, summary.gap);
    if (without_progress > (enough ? kPatienceOfEnough : kPatience))
      return stop(q, options, summary, "rounding: no further progress");
    if (applications() >= options.max_applications) {
      return stop(q, options, summary,
                  fmt::format("no convergence within {} operator applications", options.max_applications));
    }
    linearise();
    const double wanted = options.tolerance / summary.gap;
    const long left = options.max_applications - applications();
    const LinearTarget target = kIsScalar ? target_of_pressure(wanted, left, changed_, space_.free.count())
                                          : target_of_tractions(wanted, left, changed_);
    if (!take_newton_step(q, target) && !take_gradient_step(q)) {
      return stop(q, options, summary, "rounding: no step lowers the energy");
    }
  }
}

template <AdmissibleSet Set>
long NaturalMapNewton<Set>::applications() const {
  return op_.applications();
}

template <AdmissibleSet Set>
void NaturalMapNewton<Set>::enter_admissible_set(ArrayXd& q) {
  Coefficients x = Coefficients::Zero(balance_.count());
  if (balance_.solve(q, x)) balance_.add(x, q);
  set_.project(q);
  op_.apply_own(q, u_);
  energy_ = energy(q, u_);
}

template <AdmissibleSet Set>
template <typename Work>
void NaturalMapNewton<Set>::each(const Work& work) const {
  set_.sweep().each([&](Index first, Index last) {
    for (Index start = 0; start < size(); start += set_.cells()) work(start + first, start + last);
  });
}

template <AdmissibleSet Set>
template <typename Work>
void NaturalMapNewton<Set>::each_own(const Work& work) const {
  set_.sweep().each_own([&](Index first, Index last) {
    for (Index start = 0; start < size(); start += set_.cells()) work(start + first, start + last);
  });
}

template <AdmissibleSet Set>
template <typename Work>
double NaturalMapNewton<Set>::sum(const Work& work) const {
  return set_.sweep().template sum<double>([&](Index first, Index last, double& sum) {
    for (Index start = 0; start < size(); start += set_.cells()) sum += work(start + first, start + last);
  });
}

template <AdmissibleSet Set>
double NaturalMapNewton<Set>::energy(const ArrayXd& q, const ArrayXd& u) const {
  return sum([&](Index first, Index last) {
    double part = program_.energy(first, last, q, u);
    if (program_.energy_before == 0.0) return part;
    // The imposed loads' part is constant but for their rounding, which may be more than is left to gain.
    for (std::size_t k = 0; k < c_.size(); ++k) {
      part -= multipliers_[static_cast<Index>(k)] * c_[k]->dot(first, q.segment(first, last - first));
    }
    return part;
  });
}

template <AdmissibleSet Set>
void NaturalMapNewton<Set>::write_slip(ArrayXd& s) const {
  each([&](Index first, Index last) { program_.write_slip(first, last, u_, multipliers_, s); });
}

template <AdmissibleSet Set>
Eigen::ArrayXd NaturalMapNewton<Set>::take_slip() {
  clear(set_.sweep(), y_);
  write_slip(y_);
  return std::move(y_);
}

/// y = q - length * gradient, without the imposed conditions' part.
template <AdmissibleSet Set>
void NaturalMapNewton<Set>::descend(const ArrayXd& q, double length, ArrayXd& y) const {
  each([&](Index first, Index last) { program_.descend(first, last, q, u_, length, y); });
}

/// The multipliers by the natural map, and y = q - rho s.
template <AdmissibleSet Set>
bool NaturalMapNewton<Set>::find_state(const ArrayXd& q) {
  descend(q, rho_, y_);
  Coefficients x = rho_ * multipliers_;
  if (!balance_.solve(y_, x)) return false;
  multipliers_ = x / rho_;
  balance_.add(x, y_);
  return true;
}

template <AdmissibleSet Set>
double NaturalMapNewton<Set>::relative_gap(const ArrayXd& q) {
  elastic_ = sum([&](Index first, Index last) {
    program_.write_slip(first, last, u_, multipliers_, trial_u_);
    return 0.5 * (q.segment(first, last - first) * u_.segment(first, last - first)).sum();
  });
  gap_ = set_.gap(q, trial_u_);
  if (gap_ == 0.0) return 0.0;
  // Next to no traction its rounding may be less than nothing.
  if (std::abs(elastic_) <= kEnergyRounding * program_.energy_before) elastic_ = 0.0;
  return elastic_ >= 0.0 ? gap_ / elastic_ : std::numeric_limits<double>::quiet_NaN();
}

/// Of the gap that relative_gap() has just found, over the larger of the two energies.
template <AdmissibleSet Set>
bool NaturalMapNewton<Set>::is_certified(double tolerance) const {
  const double energy = std::max(elastic_, program_.energy_before);
  return solver::is_certified(gap_ / energy, set_.gap_rounding(trial_u_, u_, program_.g) / energy, tolerance);
}

template <AdmissibleSet Set>
void NaturalMapNewton<Set>::linearise() {
  changed_ = set_.linearise(y_, rho_, mean_, space_);
  if (kIsScalar) extension_.prepare(space_.f1);
  TangentPreconditioner map = preconditioner();
  if (has_tangents_ && tangents_are_near()) {
    has_tangents_ = constraints_.restrict_tangents(map, set_.sweep(), work().y);
    return;
  }
  has_tangents_ = constraints_.prepare(map, c_, work().d, work().y);
  prepared_at_ = multipliers_;
}

/// Whether those of an earlier step will do: hardly a cell has changed its state since the last step, and
/// slip, which the tangent space's stiffness goes with, has not changed much since they were made.
template <AdmissibleSet Set>
bool NaturalMapNewton<Set>::tangents_are_near() const {
  return static_cast<double>(changed_) <= kFewChanges * static_cast<double>(space_.free.count()) &&
         (multipliers_ - prepared_at_).norm() <= kNearMultipliers * multipliers_.norm();
}

/// Right-hand side -(s + stiffness q), of which the tangent space sees the turning part of q.
template <AdmissibleSet Set>
void NaturalMapNewton<Set>::write_residual(const ArrayXd& q) {
  each([&](Index first, Index last) {
    const Index n = last - first;
    program_.write_slip(first, last, u_, multipliers_, trial_u_);
    auto s = trial_u_.segment(first, n);
    if (Set::kComponents == 2) {
      s += space_.stiffness.segment(first % set_.cells(), n).template cast<double>() * q.segment(first, n);
    }
    r_.segment(first, n) = -s;
  });
}

/// loads: of the solution; empty: none. False where conjugate gradients broke down.
template <AdmissibleSet Set>
bool NaturalMapNewton<Set>::solve_linear(const ArrayXd& q, const LinearTarget& target,
                                         const Coefficients& loads) {
  write_residual(q);
  TangentOperator map = tangent_operator();
  TangentPreconditioner inverse = preconditioner();
  clear(set_.sweep(), x_);
  if (loads.size() > 0) {
    constraints_.add_with_values(inverse, loads, x_);
    Field& Ax = work().Ad;
    map.transform(x_, Ax);
    space_.free.each([&](Index first, Index last) { map.store(first, last, x_, Ax); });
    each(
        [&](Index first, Index last) { r_.segment(first, last - first) -= Ax.segment(first, last - first); });
  }
  const CgConstraints<MotionField> none;
  const CgSummary solved = projected_cg(map, inverse, has_tangents_ ? constraints_ : none, r_,
                                        {target.reduction, target.max_iterations}, work(), x_);
  if (!solved.broke_down()) return true;
  safeguards_ += {.breakdowns = 1, .breakdown = solved.message()};
  return false;
}

/// The loads that cells bring which jump onto the face of their set.
template <AdmissibleSet Set>
Coefficients NaturalMapNewton<Set>::jump_loads(const ArrayXd& q) {
  clear(set_.sweep(), trial_);
  set_.add_jump(y_, q, trial_);
  Coefficients loads(balance_.count());
  for (Eigen::Index k = 0; k < loads.size(); ++k) {
    const MotionField& c = *program_.imposed[static_cast<std::size_t>(k)].c;
    loads[k] =
        sum([&](Index first, Index last) { return c.dot(first, trial_.segment(first, last - first)); });
  }
  return loads;
}

/// The part of the way from q to the trial at which the energy is least, wherever that is: it is quadratic,
/// of slope s.(trial - q), and y = q - rho s.
template <AdmissibleSet Set>
double NaturalMapNewton<Set>::least_energy_at(const ArrayXd& q) const {
  const double slope = sum([&](Index first, Index last) {
    const Index n = last - first;
    return ((q.segment(first, n) - y_.segment(first, n)) * (trial_.segment(first, n) - q.segment(first, n)))
        .sum();
  });
  const double curvature = sum([&](Index first, Index last) {
    const Index n = last - first;
    return ((trial_.segment(first, n) - q.segment(first, n)) *
            (trial_u_.segment(first, n) - u_.segment(first, n)))
        .sum();
  });
  return -slope / (rho_ * curvature);
}

/// Whether the energy fell; then q and its displacement are the new ones.
template <AdmissibleSet Set>
bool NaturalMapNewton<Set>::accept_trial(ArrayXd& q) {
  set_.project(trial_);
  op_.apply_own(trial_, trial_u_);
  const double before = energy_;
  double after = energy(trial_, trial_u_);
  const bool lower = after <= before + kEnergyRounding * std::abs(before);
  if (const double part = kIsScalar || !lower ? least_energy_at(q) : 1.0;
      part > kLeastPart && part < kNearlyAll) {
    if (!lower) ++safeguards_.halvings;
    each_own([&](Index first, Index last) {
      const Index n = last - first;
      trial_.segment(first, n) =
          q.segment(first, n) + part * (trial_.segment(first, n) - q.segment(first, n));
      trial_u_.segment(first, n) =
          u_.segment(first, n) + part * (trial_u_.segment(first, n) - u_.segment(first, n));
    });
    after = energy(trial_, trial_u_);
  }
  if (!(after <= before + kEnergyRounding * std::abs(before))) return false;
  energy_fell_ = after < before - kEnergyRounding * std::abs(before);
  energy_ = after;
  q.swap(trial_);
  u_.swap(trial_u_);
  return true;
}

/// trial = q and this part of the linear solution and of the jumps.
template <AdmissibleSet Set>
void NaturalMapNewton<Set>::write_trial(const ArrayXd& q, double length) {
  clear(set_.sweep(), trial_);
  each([&](Index first, Index last) {
    trial_.segment(first, last - first) = x_.segment(first, last - first);
  });
  set_.add_jump(y_, q, trial_);
  each([&](Index first, Index last) {
    auto trial = trial_.segment(first, last - first);
    trial = q.segment(first, last - first) + length * trial;
  });
  if constexpr (kIsScalar) extension_.hand_on(set_.sweep(), space_.f1, trial_, d_, r_);
}

template <AdmissibleSet Set>
bool NaturalMapNewton<Set>::take_newton_step(ArrayXd& q, const LinearTarget& target) {
  if (!solve_linear(q, target)) return false;
  write_trial(q, 1.0);
  bool restored = restore_along_tangents();
  if (!kIsScalar && !restored && has_tangents_ && balance_.count() > 0) {
    ++safeguards_.second_solves;
    if (!solve_linear(q, target, -jump_loads(q))) return false;
    write_trial(q, 1.0);
    restored = restore_along_tangents();
  }
  for (int halvings = 0; halvings <= kMaxHalvings; ++halvings) {
    if (halvings > 0) {
      ++safeguards_.halvings;
      write_trial(q, std::ldexp(1.0, -halvings));
      restored = restore_along_tangents();
    }
    if ((restored || restore_along_conditions()) && accept_trial(q)) return true;
  }
  return false;
}

/// The loads of the projected trial, restored; false if that is not possible near by.
template <AdmissibleSet Set>
bool NaturalMapNewton<Set>::restore_along_tangents() {
  if (!has_tangents_) return false;
  Coefficients x = Coefficients::Zero(balance_.count());
  const auto tangents = constraints_.tangents();
  std::array<const CgTangent*, kMaxConditions> directions{};
  std::ranges::transform(tangents, directions.begin(), [](const CgTangent& tangent) { return &tangent; });
  if (!balance_.template solve_along<CgTangent>(trial_, std::span(directions).first(tangents.size()), x))
    return false;
  each([&](Index first, Index last) {
    for (std::size_t k = 0; k < tangents.size(); ++k) {
      trial_.segment(first, last - first) +=
          x[static_cast<Index>(k)] * tangents[k].segment(first, last - first).template cast<double>();
    }
  });
  return true;
}

template <AdmissibleSet Set>
bool NaturalMapNewton<Set>::restore_along_conditions() {
  Coefficients x = Coefficients::Zero(balance_.count());
  if (!balance_.solve(trial_, x)) return false;
  balance_.add(x, trial_);
  return true;
}

template <AdmissibleSet Set>
bool NaturalMapNewton<Set>::take_gradient_step(ArrayXd& q) {
  for (int halvings = 0; halvings <= kMaxGradientHalvings; halvings += 2) {
    const double length = std::ldexp(rho_, -halvings);
    clear(set_.sweep(), trial_);
    descend(q, length, trial_);
    Coefficients x = length * multipliers_;
    if (!balance_.solve(trial_, x)) continue;
    balance_.add(x, trial_);
    if (!accept_trial(q)) continue;
    ++safeguards_.gradient_steps;
    return true;
  }
  return false;
}

/// The multipliers to second order: those of a Newton step that keeps the loads. False if the gap at those
/// multipliers is above the tolerance: then another step is due.
template <AdmissibleSet Set>
bool NaturalMapNewton<Set>::refine(const ArrayXd& q, double tolerance, NewtonSummary& summary) {
  linearise();
  if (!has_tangents_ || balance_.count() == 0) return true;
  write_residual(q);
  clear(set_.sweep(), x_);
  TangentOperator map = tangent_operator();
  TangentPreconditioner inverse = preconditioner();
  const CgSummary step = projected_cg(map, inverse, constraints_, r_, {0.0, kRefiningIterations}, work(), x_);
  if (step.broke_down()) return true;
  const Coefficients first_order = multipliers_;
  multipliers_ -= step.multipliers;
  const double gap = relative_gap(q);
  if (gap <= tolerance) {
    summary.gap = gap;
    summary.multipliers = multipliers_;
    return true;
  }
  multipliers_ = first_order;
  has_tangents_ = false;
  return false;
}

/// An admissible state from which no step leads on, described as well as it can be: short of its tolerance,
/// or within it where rounding keeps the multipliers of second order out.
template <AdmissibleSet Set>
NewtonSummary NaturalMapNewton<Set>::stop(const ArrayXd& q, const NewtonOptions& options,
                                          NewtonSummary& summary, const std::string& why) {
  if (options.refine_multipliers) refine(q, summary.gap, summary);
  summary.gap = relative_gap(q);
  summary.converged = is_certified(options.tolerance);
  return summary.converged ? summary : fail(summary, why);
}

template class NaturalMapNewton<FrictionDiscs>;
template class NaturalMapNewton<PositivePressures>;

}  // namespace slipstick::solver
