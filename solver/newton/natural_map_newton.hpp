#pragma once

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "solver/newton/admissible.hpp"
#include "solver/newton/conjugate_gradients.hpp"
#include "solver/newton/load_balance.hpp"

namespace slipstick::solver {

/// minimise q.Kq/2 + g.q - sum of multiplier_k c_k.q over the admissible q: with c_k.q = load_k for each
/// condition that is imposed, which finds its multiplier, and with a given multiplier for the others. Fields
/// of kComponents*cells values; not owned.
struct ConvexProgram {
  const Eigen::ArrayXd* g = nullptr;  ///< null: zero
  std::vector<Condition> imposed;     ///< at most kMostConditions, with those that follow
  struct Given {
    const Eigen::ArrayXd* c;
    double multiplier;
  };
  std::vector<Given> given = {};
};

struct NewtonOptions {
  double tolerance = 1e-8;       ///< on gap / (q.Kq/2); see is_certified()
  long max_applications = 1000;  ///< of the operator
  /// Whether the multipliers and the tangent stiffness are wanted to second order, at some applications more.
  bool refine_multipliers = true;
  std::function<void(long applications, double gap)> progress = {};
};

struct NewtonSummary {
  bool converged = false;
  std::string message;                                    ///< why not
  double gap = std::numeric_limits<double>::quiet_NaN();  ///< over q.Kq/2
  Coefficients multipliers;                               ///< of the imposed conditions
  /// d(load)/d(multiplier) at the solution, of the imposed conditions and after them the given ones; empty
  /// where it is not known.
  CoefficientMatrix tangent_stiffness;
  int iterations = 0;
};

/// Semismooth Newton method on the natural map q = P(q - rho (Kq + g - multipliers c)) of a convex program
/// over a product of small sets (Hintermueller, Ito and Kunisch 2003; for friction Alart and Curnier 1991).
///
/// Each step fixes the state that the natural map gives to every cell and solves the linear problem in the
/// tangent space by conjugate gradients, in the precision Real; the residual is always double. The step's end
/// is projected onto the admissible set and the loads restored along the tangent fields (K + stiffness)^-1 c,
/// which disturb the multipliers alone. Near gross slip these fields bring the loads back to second order
/// only, and cannot make up for what cells bring that jump onto their circles; where they fail the linear
/// problem is solved again with the jumps' loads taken out of it. The step is halved until the energy falls;
/// where even that fails, steps of the projected gradient take over, which always descend.
template <class Set, typename Real>
class NaturalMapNewton {
 public:
  using ArrayXd = Eigen::ArrayXd;

  /// op and inner evaluate the same displacements; with Real = double they may be one object.
  NaturalMapNewton(const Set& set, const ConvexProgram& program, LinearOperator& op, Operator<Real>& inner,
                   InverseSymbol<Real>& symbol)
      : set_(set),
        program_(program),
        op_(op),
        inner_(inner),
        mean_(symbol.diagonal()),
        rho_(kRho * 0.5 * (mean_[0] + mean_[1])),
        cg_(inner, symbol, size(), conditions(program)),
        space_(Set::kComponents, set.cells()),
        balance_(set, program.imposed),
        u_(size()),
        y_(size()),
        trial_(size()),
        trial_u_(size()) {
    for (const Condition& condition : program.imposed) add_condition(*condition.c);
    for (const auto& given : program.given) add_condition(*given.c);
    if constexpr (!std::is_same_v<Real, double>) {
      for (const Field& field : rounded_) c_.push_back(&field);
    }
  }

  /// Improves q, any field of the right size, until its certificate holds.
  /// multipliers: guesses of those of the imposed conditions, or empty.
  NewtonSummary run(ArrayXd& q, const Coefficients& multipliers, const NewtonOptions& options) {
    NewtonSummary summary;
    multipliers_ =
        multipliers.size() == balance_.count() ? multipliers : Coefficients::Zero(balance_.count());
    enter_admissible_set(q);
    double best_gap = std::numeric_limits<double>::infinity();
    int without_progress = 0;
    for (;; ++summary.iterations) {
      if (!find_state(q))
        return fail(summary, "no multiplier restores the load: it is not finite, or at its limit");
      summary.gap = relative_gap(q);
      summary.multipliers = multipliers_;
      if (options.progress) options.progress(applications(), summary.gap);
      if (std::isnan(summary.gap)) return fail(summary, "an elastic energy that is not a positive number");
      if (summary.gap <= options.tolerance &&
          (!options.refine_multipliers || refine(q, options.tolerance, summary))) {
        summary.converged = true;
        return summary;
      }
      const bool settled = summary.iterations > 0 && !energy_fell_;
      if (settled && summary.gap > options.tolerance && is_certified(summary.gap, options.tolerance, q)) {
        return stop(q, options, summary, "rounding");
      }
      without_progress = summary.gap < best_gap || energy_fell_ ? 0 : without_progress + 1;
      best_gap = std::min(best_gap, summary.gap);
      if (without_progress > kPatience) return stop(q, options, summary, "rounding: no further progress");
      if (applications() >= options.max_applications) {
        return stop(q, options, summary,
                    fmt::format("no convergence within {} operator applications", options.max_applications));
      }
      linearise();
      const LinearTarget target =
          linear_target(options.tolerance / summary.gap, options.max_applications - applications());
      if (!take_newton_step(q, target) && !take_gradient_step(q)) {
        return stop(q, options, summary, "rounding: no step lowers the energy");
      }
    }
  }

  /// K q of the last q.
  const ArrayXd& displacement() const { return u_; }

  /// s = u + g - multipliers c of the last q.
  void write_slip(ArrayXd& s) const {
    s = u_;
    if (program_.g != nullptr) s += *program_.g;
    for (const auto& [c, multiplier] : program_.given) s -= multiplier * *c;
    balance_.add(-multipliers_, s);
  }

  long applications() const {
    const bool one = static_cast<const void*>(&op_) == static_cast<const void*>(&inner_);
    return op_.applications() + (one ? 0 : inner_.applications());
  }

  /// Memory of the workspaces for so many cells and conditions.
  static double bytes(double cells, std::size_t conditions) {
    const double values = static_cast<double>(Set::kComponents) * cells;
    const double rounded = std::is_same_v<Real, double> ? 0.0 : static_cast<double>(conditions);
    return kDoubleFields * sizeof(double) * values + rounded * sizeof(Real) * values +
           ConjugateGradients<Real>::bytes(values, conditions) +
           TangentSpace<Real>::bytes(Set::kComponents, cells);
  }

  static std::size_t conditions(const ConvexProgram& program) {
    return program.imposed.size() + program.given.size();
  }

 private:
  using Field = typename Operator<Real>::Field;

  /// rho over the mean of the inverse symbol. Smaller is more careful about changing cells' states; between
  /// 0.1 and 0.3 makes no difference, 1 overshoots.
  static constexpr double kRho = 0.2;
  /// The inner residual falls by this while states change, and by what the tolerance needs once they stand.
  static constexpr double kLooseReduction = 0.1;
  static constexpr double kTightReduction = 1e-4;
  static constexpr int kInnerIterations = 40;
  /// Steps towards the tangent field at the end; each brings it nearer by about 5.
  static constexpr int kTangentIterations = 3;
  static constexpr int kPatience = 8;
  /// Of a Newton step, and of a gradient step of length rho, before it is given up.
  static constexpr int kMostHalvings = 6;
  static constexpr int kMostGradientHalvings = 30;
  /// Energies are compared up to their rounding.
  static constexpr double kEnergyRounding = 1e-13;

  static constexpr double kDoubleFields = 4.0;  ///< u_, y_, trial_, trial_u_

  Index size() const { return Set::kComponents * set_.cells(); }

  /// A condition's field in the precision of the inner iteration.
  void add_condition(const ArrayXd& c) {
    if constexpr (std::is_same_v<Real, double>) {
      c_.push_back(&c);
    } else {
      rounded_.push_back(c.template cast<Real>());
    }
  }
  std::span<const Field* const> conditions() const { return c_; }
  std::span<const Field* const> imposed() const {
    return conditions().first(static_cast<std::size_t>(balance_.count()));
  }

  void enter_admissible_set(ArrayXd& q) {
    Coefficients x = Coefficients::Zero(balance_.count());
    if (balance_.solve(q, x)) balance_.add(x, q);
    set_.project(q);
    op_.apply(q, u_);
  }

  /// The multipliers by the natural map, and y = q - rho s.
  bool find_state(const ArrayXd& q) {
    y_ = q - rho_ * u_;
    if (program_.g != nullptr) y_ -= rho_ * *program_.g;
    for (const auto& [c, multiplier] : program_.given) y_ += (rho_ * multiplier) * *c;
    Coefficients x = rho_ * multipliers_;
    if (!balance_.solve(y_, x)) return false;
    multipliers_ = x / rho_;
    balance_.add(x, y_);
    return true;
  }

  double energy(const ArrayXd& q, const ArrayXd& u) const {
    double sum = 0.5 * (q * u).sum();
    if (program_.g != nullptr) sum += (q * *program_.g).sum();
    for (const auto& [c, multiplier] : program_.given) sum -= multiplier * (q * *c).sum();
    return sum;
  }

  double relative_gap(const ArrayXd& q) {
    const double elastic = 0.5 * (q * u_).sum();
    write_slip(trial_u_);
    const double gap = set_.gap(q, trial_u_);
    if (gap == 0.0) return 0.0;
    return elastic >= 0.0 ? gap / elastic : std::numeric_limits<double>::quiet_NaN();
  }

  /// Of the gap that relative_gap() has just found.
  bool is_certified(double gap, double tolerance, const ArrayXd& q) const {
    double rounding = 0.0;
    if constexpr (Set::kComponents == 2) {
      rounding = set_.gap_rounding(trial_u_, u_) / (0.5 * (q * u_).sum());
    }
    return solver::is_certified(gap, rounding, tolerance);
  }

  void linearise() {
    changed_ = set_.linearise(y_, rho_, mean_, space_);
    has_tangents_ = cg_.precondition(space_, imposed());
  }

  /// Right-hand side -(s + stiffness q), of which the tangent space sees the turning part of q.
  void write_residual(const ArrayXd& q) {
    write_slip(trial_u_);
    if (Set::kComponents == 2) {
      const Index n = set_.cells();
      const auto& stiffness = space_.stiffness.template cast<double>();
      trial_u_.head(n) += stiffness * q.head(n);
      trial_u_.tail(n) += stiffness * q.tail(n);
    }
    cg_.residual() = -trial_u_.template cast<Real>();
  }

  struct LinearTarget {
    double reduction;  ///< of the residual
    int max_iterations;
  };

  /// wanted: the part that is to be left of the gap.
  LinearTarget linear_target(double wanted, long applications_left) const {
    return {changed_ == 0 ? std::clamp(0.3 * wanted, kTightReduction, kLooseReduction) : kLooseReduction,
            static_cast<int>(std::clamp<long>(applications_left, 1, kInnerIterations))};
  }

  /// loads: of the solution; empty: none. False where conjugate gradients broke down.
  bool solve_linear(const ArrayXd& q, const LinearTarget& target, const Coefficients& loads = {}) {
    write_residual(q);
    const auto kept = has_tangents_ ? imposed() : std::span<const Field* const>();
    return cg_.solve(space_, kept, target.reduction, target.max_iterations, loads).breakdown.empty();
  }

  /// The loads that cells bring which jump onto the face of their set.
  Coefficients jump_loads(const ArrayXd& q) {
    trial_.setZero();
    set_.add_jump(y_, q, trial_);
    Coefficients loads(balance_.count());
    for (Eigen::Index k = 0; k < loads.size(); ++k) {
      loads[k] = (*program_.imposed[static_cast<std::size_t>(k)].c * trial_).sum();
    }
    return loads;
  }

  /// Whether the energy fell; then q and its displacement are the new ones.
  bool accept_trial(ArrayXd& q) {
    set_.project(trial_);
    op_.apply(trial_, trial_u_);
    const double before = energy(q, u_);
    const double after = energy(trial_, trial_u_);
    if (!(after <= before + kEnergyRounding * std::abs(before))) return false;
    energy_fell_ = after < before - kEnergyRounding * std::abs(before);
    q.swap(trial_);
    u_.swap(trial_u_);
    return true;
  }

  /// trial = q and this part of the linear solution and of the jumps.
  void write_trial(const ArrayXd& q, double length) {
    trial_ = cg_.solution().template cast<double>();
    set_.add_jump(y_, q, trial_);
    trial_ = q + length * trial_;
  }

  bool take_newton_step(ArrayXd& q, const LinearTarget& target) {
    if (!solve_linear(q, target)) return false;
    write_trial(q, 1.0);
    bool restored = restore_along_tangents();
    if (!restored && has_tangents_ && balance_.count() > 0) {
      if (!solve_linear(q, target, -jump_loads(q))) return false;
      write_trial(q, 1.0);
      restored = restore_along_tangents();
    }
    for (int halvings = 0; halvings <= kMostHalvings; ++halvings) {
      if (halvings > 0) {
        write_trial(q, std::ldexp(1.0, -halvings));
        restored = restore_along_tangents();
      }
      if ((restored || restore_along_conditions()) && accept_trial(q)) return true;
    }
    return false;
  }

  /// The loads of the projected trial, restored; false if that is not possible near by.
  bool restore_along_tangents() {
    if (!has_tangents_) return false;
    Coefficients x = Coefficients::Zero(balance_.count());
    const auto tangents = cg_.tangents().first(imposed().size());
    if (!balance_.template solve_along<Field>(trial_, tangents, x)) return false;
    for (std::size_t k = 0; k < tangents.size(); ++k) {
      trial_ += x[static_cast<Eigen::Index>(k)] * tangents[k]->template cast<double>();
    }
    return true;
  }

  bool restore_along_conditions() {
    Coefficients x = Coefficients::Zero(balance_.count());
    if (!balance_.solve(trial_, x)) return false;
    balance_.add(x, trial_);
    return true;
  }

  bool take_gradient_step(ArrayXd& q) {
    for (int halvings = 0; halvings <= kMostGradientHalvings; halvings += 2) {
      const double length = std::ldexp(rho_, -halvings);
      trial_ = q - length * u_;
      if (program_.g != nullptr) trial_ -= length * *program_.g;
      for (const auto& [c, multiplier] : program_.given) trial_ += (length * multiplier) * *c;
      Coefficients x = length * multipliers_;
      if (!balance_.solve(trial_, x)) continue;
      balance_.add(x, trial_);
      if (accept_trial(q)) return true;
    }
    return false;
  }

  /// The multipliers to second order: those of a Newton step along the tangent fields w, from w.(s +
  /// stiffness q) and w.c. False if the gap at those multipliers is above the tolerance: then another step is
  /// due.
  bool refine(const ArrayXd& q, double tolerance, NewtonSummary& summary) {
    linearise();
    summary.tangent_stiffness = CoefficientMatrix();
    if (!has_tangents_) return true;
    summary.tangent_stiffness = cg_.solve_for_conditions(space_, conditions(), kTangentIterations);
    const Eigen::Index n = balance_.count();
    if (n == 0) return true;
    const Eigen::LLT<CoefficientMatrix> factor(
        CoefficientMatrix(summary.tangent_stiffness.topLeftCorner(n, n)));
    if (factor.info() != Eigen::Success) return true;
    write_residual(q);
    Coefficients products(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      products[k] = (cg_.residual().template cast<double>() *
                     cg_.tangents()[static_cast<std::size_t>(k)]->template cast<double>())
                        .sum();
    }
    const Coefficients first_order = multipliers_;
    multipliers_ -= factor.solve(products);
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
  NewtonSummary stop(const ArrayXd& q, const NewtonOptions& options, NewtonSummary& summary,
                     const std::string& why) {
    if (options.refine_multipliers) refine(q, summary.gap, summary);
    summary.gap = relative_gap(q);
    summary.converged = is_certified(summary.gap, options.tolerance, q);
    return summary.converged ? summary : fail(summary, why);
  }

  static NewtonSummary fail(NewtonSummary& summary, const std::string& why) {
    summary.message = why;
    return summary;
  }

  const Set& set_;
  const ConvexProgram& program_;
  LinearOperator& op_;
  Operator<Real>& inner_;
  std::array<double, 2> mean_;
  double rho_;
  ConjugateGradients<Real> cg_;
  TangentSpace<Real> space_;
  LoadBalance<Set> balance_;
  std::vector<Field> rounded_;   ///< the conditions' fields, unless they are in this precision already
  std::vector<const Field*> c_;  ///< those of the imposed conditions, then the given ones
  ArrayXd u_, y_, trial_, trial_u_;
  Coefficients multipliers_;  ///< of the imposed conditions
  Index changed_ = 0;
  bool has_tangents_ = false;
  bool energy_fell_ = false;  ///< in the last step, by more than its rounding
};

}  // namespace slipstick::solver
