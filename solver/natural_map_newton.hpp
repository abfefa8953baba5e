#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "solver/admissible.hpp"
#include "solver/conjugate_gradients.hpp"

namespace slipstick::solver {

/// minimise q.Kq/2 + g.q over the admissible q with c.q = load, or q.Kq/2 + g.q - multiplier c.q without
/// condition where the multiplier is given. Fields of kComponents*cells values; not owned.
struct ConvexProgram {
  const Eigen::ArrayXd* g = nullptr;  ///< null: zero
  const Eigen::ArrayXd& c;
  std::optional<double> load;
  std::optional<double> multiplier;
};

struct NewtonOptions {
  double tolerance = 1e-8;       ///< on gap / (q.Kq/2)
  long max_applications = 1000;  ///< of the operator
  /// Whether the multiplier and the tangent stiffness are wanted to second order, at some applications more.
  bool refine_multiplier = true;
  std::function<void(long applications, double gap)> progress = {};
};

struct NewtonSummary {
  bool converged = false;
  std::string message;                                    ///< why not
  double gap = std::numeric_limits<double>::quiet_NaN();  ///< over q.Kq/2
  double multiplier = 0.0;
  /// d(load)/d(multiplier) at the solution; 0 where nothing sticks.
  double tangent_stiffness = 0.0;
  int iterations = 0;
};

/// Semismooth Newton method on the natural map q = P(q - rho (Kq + g - multiplier c)) of a convex program
/// over a product of small sets (Hintermueller, Ito and Kunisch 2003; for friction Alart and Curnier 1991).
///
/// Each step fixes the state that the natural map gives to every cell and solves the linear problem in the
/// tangent space by conjugate gradients, in the precision Real; the residual is always double. The step's end
/// is projected onto the admissible set and the load restored along the tangent field (K + stiffness)^-1 c,
/// which disturbs the multiplier alone. The step is halved until the energy falls; where even that fails,
/// steps of the projected gradient take over, which always descend.
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
        cg_(inner, symbol, size()),
        space_(Set::kComponents, set.cells()),
        c_(program.c.template cast<Real>()),
        u_(size()),
        y_(size()),
        trial_(size()),
        trial_u_(size()),
        total_load_(scale_of_load()) {}

  /// Improves q, any field of the right size, until its certificate holds.
  NewtonSummary run(ArrayXd& q, double multiplier, const NewtonOptions& options) {
    NewtonSummary summary;
    multiplier_ = program_.multiplier.value_or(multiplier);
    enter_admissible_set(q);
    double best_gap = std::numeric_limits<double>::infinity();
    int without_progress = 0;
    for (;; ++summary.iterations) {
      if (!find_state(q))
        return fail(summary, "no multiplier restores the load: it is not finite, or at its limit");
      summary.gap = relative_gap(q);
      summary.multiplier = multiplier_;
      if (options.progress) options.progress(applications(), summary.gap);
      if (std::isnan(summary.gap)) return fail(summary, "an elastic energy that is not a positive number");
      if (summary.gap <= options.tolerance &&
          (!options.refine_multiplier || refine(q, options.tolerance, summary))) {
        summary.converged = true;
        return summary;
      }
      without_progress = summary.gap < best_gap || energy_fell_ ? 0 : without_progress + 1;
      best_gap = std::min(best_gap, summary.gap);
      if (without_progress > kPatience) return stop(q, options, summary, "rounding: no further progress");
      if (applications() >= options.max_applications) {
        return stop(q, options, summary,
                    fmt::format("no convergence within {} operator applications", options.max_applications));
      }
      linearise();
      const bool solved =
          solve_linear(q, options.tolerance / summary.gap, options.max_applications - applications());
      if (!(solved && take_newton_step(q)) && !take_gradient_step(q)) {
        return stop(q, options, summary, "rounding: no step lowers the energy");
      }
    }
  }

  /// K q of the last q.
  const ArrayXd& displacement() const { return u_; }

  long applications() const {
    const bool one = static_cast<const void*>(&op_) == static_cast<const void*>(&inner_);
    return op_.applications() + (one ? 0 : inner_.applications());
  }

  /// Memory of the workspaces for so many cells.
  static double bytes(double cells) {
    const double values = static_cast<double>(Set::kComponents) * cells;
    return kDoubleFields * sizeof(double) * values + sizeof(Real) * values +
           ConjugateGradients<Real>::bytes(values) + TangentSpace<Real>::bytes(Set::kComponents, cells);
  }

 private:
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
  static constexpr double kLoadRounding = 1e-14;
  static constexpr int kRootIterations = 60;

  static constexpr double kDoubleFields = 4.0;  ///< u_, y_, trial_, trial_u_

  Index size() const { return Set::kComponents * set_.cells(); }

  /// What the load's rounding is relative to.
  double scale_of_load() const {
    if (!program_.load) return 1.0;
    return std::max(std::abs(*program_.load), std::numeric_limits<double>::min());
  }

  void enter_admissible_set(ArrayXd& q) {
    if (program_.load) {
      const auto x = find_load(q, program_.c, 0.0);
      if (x) q += *x * program_.c;
    }
    set_.project(q);
    op_.apply(q, u_);
  }

  /// x with c.P(y + x direction) = load, by Newton's method in a bracket. None if there is none within reach.
  template <typename Direction>
  std::optional<double> find_load(const ArrayXd& y, const Direction& direction, double start) const {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    double x = start;
    double stride = 0.0;
    for (int i = 0; i < kRootIterations; ++i) {
      const LoadAlong at = set_.load_along(y, direction, x, program_.c);
      const double excess = at.load - *program_.load;
      if (std::abs(excess) <= kLoadRounding * total_load_) return x;
      if (!std::isfinite(excess)) return std::nullopt;
      (excess < 0.0 ? low : high) = x;
      double next = x - excess / at.slope;
      if (at.slope > 0.0) stride = std::max(stride, std::abs(next - x));
      if (!(at.slope > 0.0) || !(next > low && next < high)) {
        const bool bracketed = std::isfinite(low) && std::isfinite(high);
        stride = stride > 0.0 ? 2.0 * stride : 1.0;
        next = bracketed ? 0.5 * (low + high) : x + (excess < 0.0 ? stride : -stride);
      }
      if (next == x || !(high - low > std::numeric_limits<double>::epsilon() * std::abs(x))) return x;
      x = next;
    }
    return std::nullopt;
  }

  /// The multiplier by the natural map, and y = q - rho s.
  bool find_state(const ArrayXd& q) {
    y_ = q - rho_ * u_;
    if (program_.g != nullptr) y_ -= rho_ * *program_.g;
    if (program_.load) {
      const auto x = find_load(y_, program_.c, rho_ * multiplier_);
      if (!x) return false;
      multiplier_ = *x / rho_;
    }
    y_ += (rho_ * multiplier_) * program_.c;
    return true;
  }

  double energy(const ArrayXd& q, const ArrayXd& u) const {
    double sum = 0.5 * (q * u).sum();
    if (program_.g != nullptr) sum += (q * *program_.g).sum();
    if (program_.multiplier) sum -= *program_.multiplier * (q * program_.c).sum();
    return sum;
  }

  double relative_gap(const ArrayXd& q) {
    const double elastic = 0.5 * (q * u_).sum();
    if (program_.g != nullptr) trial_u_ = u_ + *program_.g;
    const double gap = set_.gap(q, program_.g != nullptr ? trial_u_ : u_, program_.c, multiplier_);
    if (gap == 0.0) return 0.0;
    return elastic >= 0.0 ? gap / elastic : std::numeric_limits<double>::quiet_NaN();
  }

  void linearise() {
    changed_ = set_.linearise(y_, rho_, mean_, space_);
    has_tangent_ = cg_.precondition_condition(space_, c_);
  }

  /// Right-hand side -(s + stiffness q), of which the tangent space sees the turning part of q.
  void write_residual(const ArrayXd& q) {
    const Index n = set_.cells();
    auto& r = cg_.residual();
    for (Index component = 0; component < Set::kComponents; ++component) {
      for (Index i = component * n; i < (component + 1) * n; ++i) {
        double value = multiplier_ * program_.c[i] - u_[i];
        if (program_.g != nullptr) value -= (*program_.g)[i];
        if (Set::kComponents == 2) value -= static_cast<double>(space_.stiffness[i - component * n]) * q[i];
        r[i] = static_cast<Real>(value);
      }
    }
  }

  /// False where conjugate gradients broke down.
  bool solve_linear(const ArrayXd& q, double wanted, long applications_left) {
    write_residual(q);
    const double reduction =
        changed_ == 0 ? std::clamp(0.3 * wanted, kTightReduction, kLooseReduction) : kLooseReduction;
    const auto most = static_cast<int>(std::clamp<long>(applications_left, 1, kInnerIterations));
    const auto* const condition = program_.load && has_tangent_ ? &c_ : nullptr;
    return cg_.solve(space_, condition, reduction, most).breakdown.empty();
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

  bool take_newton_step(ArrayXd& q) {
    for (int halvings = 0; halvings <= kMostHalvings; ++halvings) {
      const double length = std::ldexp(1.0, -halvings);
      trial_ = cg_.solution().template cast<double>();
      set_.add_jump(y_, q, trial_);
      trial_ = q + length * trial_;
      if (program_.load && !restore_load()) continue;
      if (accept_trial(q)) return true;
    }
    return false;
  }

  /// The load of the projected trial, restored along the tangent field if it can be, else along c.
  bool restore_load() {
    if (has_tangent_) {
      if (const auto x = find_load(trial_, cg_.tangent(), 0.0)) {
        trial_ += *x * cg_.tangent().template cast<double>();
        return true;
      }
    }
    const auto x = find_load(trial_, program_.c, 0.0);
    if (x) trial_ += *x * program_.c;
    return x.has_value();
  }

  bool take_gradient_step(ArrayXd& q) {
    for (int halvings = 0; halvings <= kMostGradientHalvings; halvings += 2) {
      const double length = std::ldexp(rho_, -halvings);
      trial_ = q - length * u_;
      if (program_.g != nullptr) trial_ -= length * *program_.g;
      if (program_.load) {
        const auto x = find_load(trial_, program_.c, length * multiplier_);
        if (!x) continue;
        trial_ += *x * program_.c;
      } else {
        trial_ += (length * multiplier_) * program_.c;
      }
      if (accept_trial(q)) return true;
    }
    return false;
  }

  /// The multiplier to second order: that of a Newton step along the tangent field w, w.(s + stiffness
  /// q)/(w.c). False if the gap at that multiplier is above the tolerance: then another step is due.
  bool refine(const ArrayXd& q, double tolerance, NewtonSummary& summary) {
    linearise();
    summary.tangent_stiffness = 0.0;
    if (has_tangent_) summary.tangent_stiffness = cg_.solve_for_condition(space_, c_, kTangentIterations);
    if (!program_.load || !(summary.tangent_stiffness > 0.0)) return true;
    write_residual(q);
    const double correction =
        -(cg_.residual().template cast<double>() * cg_.tangent().template cast<double>()).sum() /
        summary.tangent_stiffness;
    const double first_order = multiplier_;
    multiplier_ += correction;
    const double gap = relative_gap(q);
    if (gap <= tolerance) {
      summary.gap = gap;
      summary.multiplier = multiplier_;
      return true;
    }
    multiplier_ = first_order;
    has_tangent_ = false;
    return false;
  }

  /// An admissible state short of its tolerance: described as well as it can be.
  NewtonSummary stop(const ArrayXd& q, const NewtonOptions& options, NewtonSummary& summary,
                     const std::string& why) {
    if (options.refine_multiplier) refine(q, summary.gap, summary);
    return fail(summary, why);
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
  typename Operator<Real>::Field c_;
  ArrayXd u_, y_, trial_, trial_u_;
  double total_load_;
  double multiplier_ = 0.0;
  Index changed_ = 0;
  bool has_tangent_ = false;
  bool energy_fell_ = false;  ///< in the last step, by more than its rounding
};

}  // namespace slipstick::solver
