#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "solver/elasticity/linear_operator.hpp"
#include "solver/grid/own_rows.hpp"
#include "solver/grid/reduction.hpp"
#include "solver/newton/admissible.hpp"
#include "solver/newton/convex_program.hpp"
#include "solver/newton/safeguards.hpp"

namespace slipstick::solver {

/// Energies are compared up to this part of them, their rounding.
inline constexpr double kEnergyRounding = 1e-13;

/// A field that may be the next q, with its displacement K q.
struct Trial {
  Eigen::ArrayXd q, u;
};

/// A step is shortened to the least energy if that lies between these parts of it. Closer to the end it is
/// taken in full, so that cells reach the faces of their sets.
inline constexpr double kMinPart = 1e-3;
inline constexpr double kNearlyAll = 0.9;

/// The state of Newton's method for a convex program: the displacement of its field q, the multipliers, the
/// argument of the natural map, and the energy. q itself belongs to the caller.
template <AdmissibleSet Set>
class NewtonState {
 public:
  using ArrayXd = Eigen::ArrayXd;
  static constexpr bool kIsScalar = Set::kComponents == 1;

  /// packing: of all fields. rho: step length of the natural map. No argument is owned.
  NewtonState(const Set& set, const ConvexProgram& program, LinearOperator& op, Packing& packing, double rho)
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

  const Set& set() const { return set_; }
  const ConvexProgram& program() const { return program_; }
  const LoadBalance<Set>& balance() const { return balance_; }
  LinearOperator& op() const { return op_; }
  Packing& packing() const { return packing_; }
  double rho() const { return rho_; }
  /// q - rho s with the slip s, which the natural map projects.
  const ArrayXd& y() const { return y_; }
  const Coefficients& multipliers() const { return multipliers_; }
  double energy() const { return energy_; }
  /// Values of a field.
  Index size() const { return Set::kComponents * set_.cells(); }

  /// work(first, last) for the values of the contact cells.
  template <typename Work>
  void each(const Work& work) const {
    set_.sweep().each([&](Index first, Index last) {
      for (Index start = 0; start < size(); start += set_.cells()) work(start + first, start + last);
    });
  }

  /// The sum of work(first, last) over them.
  template <typename Work>
  double sum(const Work& work) const {
    return set_.sweep().template sum<double>([&](Index first, Index last, double& sum) {
      for (Index start = 0; start < size(); start += set_.cells()) sum += work(start + first, start + last);
    });
  }

  /// Starts at the projection of q onto the set, with the imposed loads if a multiplier restores them.
  /// multipliers: guesses, or empty.
  void enter(ArrayXd& q, const Coefficients& multipliers) {
    multipliers_ = multipliers.size() == balance_.count() ? multipliers : Coefficients::Zero(balance_.count());
    Coefficients x = Coefficients::Zero(balance_.count());
    if (balance_.solve(q, x)) balance_.add(x, q);
    symmetrise(q);
    set_.project(q);
    op_.apply_own(q, u_, packing_);
    energy_ = energy_of(q, u_);
  }

  /// The multipliers by the natural map, and y. False if no multiplier restores the loads.
  bool find_multipliers(const ArrayXd& q) {
    descend(q, rho_, y_);
    Coefficients x = rho_ * multipliers_;
    if (!balance_.solve(y_, x)) return false;
    multipliers_ = x / rho_;
    balance_.add(x, y_);
    if (program_.energy_before > 0.0) energy_ = energy_of(q, u_);
    return true;
  }

  void set_multipliers(const Coefficients& multipliers) { multipliers_ = multipliers; }

  /// The gap over q.Kq/2, NaN unless that is positive. slip: overwritten by the slip of q.
  double relative_gap(const ArrayXd& q, ArrayXd& slip) {
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

  /// True if the last gap of relative_gap(), over the larger of q's and earlier states' energies, is within a
  /// tolerance or its rounding. slip: as relative_gap() left it.
  bool is_certified(double tolerance, const ArrayXd& slip) const {
    const double energy = std::max(elastic_, program_.energy_before);
    return solver::is_certified(gap_ / energy, set_.gap_rounding(slip, u_, program_.g) / energy, tolerance);
  }

  /// slip = K q + g - multipliers c in the values [first, last) of one row.
  void write_slip(Index first, Index last, ArrayXd& slip) const {
    program_.write_slip(first, last, u_, multipliers_, slip);
  }

  /// y = q - length * gradient, without the imposed conditions' part.
  void descend(const ArrayXd& q, double length, ArrayXd& y) const {
    each([&](Index first, Index last) { program_.descend(first, last, q, u_, length, y); });
  }

  /// Projects the trial and replaces q by it, or by the point of least energy between them. False, with q
  /// unchanged, if the energy does not fall.
  bool accept(ArrayXd& q, Trial& trial, Safeguards& safeguards) {
    symmetrise(trial.q);
    set_.project(trial.q);
    op_.apply_own(trial.q, trial.u, packing_);
    double after = energy_of(trial.q, trial.u);
    // Energies are known to the rounding of their terms.
    const double highest = energy_ + kEnergyRounding * std::abs(energy_) + kGapUnits * std::abs(program_.energy_before);
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

  /// The slip of q, zero outside the contact cells; call it before take_displacement().
  ArrayXd take_slip() {
    clear(set_.sweep(), y_);
    each([&](Index first, Index last) { write_slip(first, last, y_); });
    return std::move(y_);
  }

  ArrayXd take_displacement() { return std::move(u_); }

 private:
  /// Rounding is not its own image, and does not shrink over the steps of a history: without translations
  /// only this removes the force that it leaves.
  void symmetrise(ArrayXd& q) const {
    if (!program_.turns_into_itself) return;
    if (!op_.grid().ranks.several()) return turn_into_itself(q);
    ArrayXd whole = packing_.unpacked(q);
    share_rows(op_.grid(), whole);
    turn_into_itself(whole);
    q = packing_.packed(whole);
  }

  double energy_of(const ArrayXd& q, const ArrayXd& u) const {
    return sum([&](Index first, Index last) {
      double part = program_.energy(first, last, q, u);
      if (program_.energy_before == 0.0) return part;
      // The imposed loads' part is constant but for their rounding, which may be more than is left to gain.
      for (std::size_t k = 0; k < program_.imposed.size(); ++k) {
        part -= multipliers_[static_cast<Index>(k)] * program_.imposed[k].c->dot(first, q.segment(first, last - first));
      }
      return part;
    });
  }

  /// The t at which the energy of q + t (trial - q) is least. It is quadratic in t with the slope
  /// s.(trial - q), and y = q - rho s.
  double least_energy_at(const ArrayXd& q, const Trial& trial) const {
    const double slope = sum([&](Index first, Index last) {
      const Index n = last - first;
      return ((q.segment(first, n) - y_.segment(first, n)) * (trial.q.segment(first, n) - q.segment(first, n))).sum();
    });
    const double curvature = sum([&](Index first, Index last) {
      const Index n = last - first;
      return ((trial.q.segment(first, n) - q.segment(first, n)) * (trial.u.segment(first, n) - u_.segment(first, n)))
          .sum();
    });
    return -slope / (rho_ * curvature);
  }

  /// trial = q + part (trial - q).
  void shorten(const ArrayXd& q, Trial& trial, double part) const {
    set_.sweep().each_own([&](Index first_cell, Index last_cell) {
      const Index n = last_cell - first_cell;
      for (Index first = first_cell; first < size(); first += set_.cells()) {
        trial.q.segment(first, n) = q.segment(first, n) + part * (trial.q.segment(first, n) - q.segment(first, n));
        trial.u.segment(first, n) = u_.segment(first, n) + part * (trial.u.segment(first, n) - u_.segment(first, n));
      }
    });
  }

  const Set& set_;
  const ConvexProgram& program_;
  LinearOperator& op_;
  Packing& packing_;
  LoadBalance<Set> balance_;
  double rho_;
  ArrayXd u_, y_;
  Coefficients multipliers_;
  double energy_ = 0.0;   ///< of q
  double elastic_ = 0.0;  ///< its q.u/2, and
  double gap_ = 0.0;      ///< its gap, both from relative_gap()
};

}  // namespace slipstick::solver
