#include "solver/newton/newton_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/grid/own_rows.hpp"
#include "solver/grid/reduction.hpp"

namespace slipstick::solver {
namespace {

/// A step is shortened to the least energy if that lies between these parts of it. Closer to the end it is
/// taken in full, so that cells reach the faces of their sets.
constexpr double kMinPart = 1e-3;
constexpr double kNearlyAll = 0.9;

}  // namespace

template <AdmissibleSet Set>
NewtonState<Set>::NewtonState(const Set& set, const ConvexProgram& program, LinearOperator& op,
                              Packing& packing, double rho)
    : set_(set),
      program_(program),
      op_(op),
      packing_(packing),
      balance_(set, program.imposed),
      rho_(rho),
      u_(size()),
      y_(size()) {
  clear(set.sweep(), y_);
}

template <AdmissibleSet Set>
void NewtonState<Set>::enter(ArrayXd& q, const Coefficients& multipliers) {
  multipliers_ = multipliers.size() == balance_.count() ? multipliers : Coefficients::Zero(balance_.count());
  Coefficients x = Coefficients::Zero(balance_.count());
  if (balance_.solve(q, x)) balance_.add(x, q);
  symmetrise(q);
  set_.project(q);
  op_.apply_own(q, u_, packing_);
  energy_ = energy_of(q, u_);
}

/// Rounding is not its own image, and does not shrink over the steps of a history: without translations only
/// this removes the force that it leaves.
template <AdmissibleSet Set>
void NewtonState<Set>::symmetrise(ArrayXd& q) const {
  if (!program_.turns_into_itself) return;
  if (!op_.grid().ranks.several()) return turn_into_itself(q);
  ArrayXd whole = packing_.unpacked(q);
  share_rows(op_.grid(), whole);
  turn_into_itself(whole);
  q = packing_.packed(whole);
}

template <AdmissibleSet Set>
bool NewtonState<Set>::find_multipliers(const ArrayXd& q) {
  descend(q, rho_, y_);
  Coefficients x = rho_ * multipliers_;
  if (!balance_.solve(y_, x)) return false;
  multipliers_ = x / rho_;
  balance_.add(x, y_);
  if (program_.energy_before > 0.0) energy_ = energy_of(q, u_);
  return true;
}

template <AdmissibleSet Set>
double NewtonState<Set>::energy_of(const ArrayXd& q, const ArrayXd& u) const {
  return sum([&](Index first, Index last) {
    double part = program_.energy(first, last, q, u);
    if (program_.energy_before == 0.0) return part;
    // The imposed loads' part is constant but for their rounding, which may be more than is left to gain.
    for (std::size_t k = 0; k < program_.imposed.size(); ++k) {
      part -= multipliers_[static_cast<Index>(k)] *
              program_.imposed[k].c->dot(first, q.segment(first, last - first));
    }
    return part;
  });
}

template <AdmissibleSet Set>
double NewtonState<Set>::relative_gap(const ArrayXd& q, ArrayXd& slip) {
  elastic_ = sum([&](Index first, Index last) {
    write_slip(first, last, slip);
    return 0.5 * (q.segment(first, last - first) * u_.segment(first, last - first)).sum();
  });
  gap_ = set_.gap(q, slip);
  if (gap_ == 0.0) return 0.0;
  // For tractions near zero rounding may make it negative.
  if (std::abs(elastic_) <= kEnergyRounding * program_.energy_before) elastic_ = 0.0;
  return elastic_ >= 0.0 ? gap_ / elastic_ : std::numeric_limits<double>::quiet_NaN();
}

template <AdmissibleSet Set>
bool NewtonState<Set>::is_certified(double tolerance, const ArrayXd& slip) const {
  const double energy = std::max(elastic_, program_.energy_before);
  return solver::is_certified(gap_ / energy, set_.gap_rounding(slip, u_, program_.g) / energy, tolerance);
}

template <AdmissibleSet Set>
void NewtonState<Set>::descend(const ArrayXd& q, double length, ArrayXd& y) const {
  each([&](Index first, Index last) { program_.descend(first, last, q, u_, length, y); });
}

template <AdmissibleSet Set>
Eigen::ArrayXd NewtonState<Set>::take_slip() {
  clear(set_.sweep(), y_);
  each([&](Index first, Index last) { write_slip(first, last, y_); });
  return std::move(y_);
}

/// The t at which the energy of q + t (trial - q) is least. It is quadratic in t with the slope
/// s.(trial - q), and y = q - rho s.
template <AdmissibleSet Set>
double NewtonState<Set>::least_energy_at(const ArrayXd& q, const Trial& trial) const {
  const double slope = sum([&](Index first, Index last) {
    const Index n = last - first;
    return ((q.segment(first, n) - y_.segment(first, n)) * (trial.q.segment(first, n) - q.segment(first, n)))
        .sum();
  });
  const double curvature = sum([&](Index first, Index last) {
    const Index n = last - first;
    return ((trial.q.segment(first, n) - q.segment(first, n)) *
            (trial.u.segment(first, n) - u_.segment(first, n)))
        .sum();
  });
  return -slope / (rho_ * curvature);
}

/// trial = q + part (trial - q).
template <AdmissibleSet Set>
void NewtonState<Set>::shorten(const ArrayXd& q, Trial& trial, double part) const {
  set_.sweep().each_own([&](Index first_cell, Index last_cell) {
    const Index n = last_cell - first_cell;
    for (Index first = first_cell; first < size(); first += set_.cells()) {
      trial.q.segment(first, n) =
          q.segment(first, n) + part * (trial.q.segment(first, n) - q.segment(first, n));
      trial.u.segment(first, n) =
          u_.segment(first, n) + part * (trial.u.segment(first, n) - u_.segment(first, n));
    }
  });
}

template <AdmissibleSet Set>
bool NewtonState<Set>::accept(ArrayXd& q, Trial& trial, Safeguards& safeguards) {
  symmetrise(trial.q);
  set_.project(trial.q);
  op_.apply_own(trial.q, trial.u, packing_);
  double after = energy_of(trial.q, trial.u);
  // Energies are known to the rounding of their terms.
  const double highest =
      energy_ + kEnergyRounding * std::abs(energy_) + kGapUnits * std::abs(program_.energy_before);
  const bool lower = after <= highest;
  if (const double part = kIsScalar || !lower ? least_energy_at(q, trial) : 1.0;
      part > kMinPart && part < kNearlyAll) {
    if (!lower) ++safeguards.halvings;
    shorten(q, trial, part);
    after = energy_of(trial.q, trial.u);
  }
  if (!(after <= highest)) return false;
  energy_ = after;
  q.swap(trial.q);
  u_.swap(trial.u);
  return true;
}

template class NewtonState<FrictionDiscs>;
template class NewtonState<PositivePressures>;

}  // namespace slipstick::solver
