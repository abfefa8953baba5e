#include "solver/contact/paper_method.hpp"

#include <fmt/core.h>

#include <cmath>

#include "solver/contact/certificate.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// K q by recurrence drifts by rounding; it is computed afresh this often.
constexpr int kRefresh = 50;
constexpr int kProgressEvery = 20;

/// A factor a cell, for both components.
ArrayXd both(const ArrayXd& cell_values) { return cell_values.replicate(2, 1); }

/// Section 4 of the paper, one member a step, under the paper's names.
class PaperMethod {
 public:
  PaperMethod(LinearOperator& op, const TangentialProblem& problem, const PaperOptions& options)
      : op_(op),
        problem_(problem),
        options_(options),
        t_(rotation_field(op.grid())),
        initial_(problem.initial_displacement.size() > 0 ? problem.initial_displacement
                                                         : ArrayXd::Zero(2 * op.grid().cells())),
        total_friction_(problem.friction_bound.sum()),
        contact_((problem.friction_bound > 0.0).cast<double>()),
        stick_(contact_),
        q_(ArrayXd::Zero(t_.size())),
        u_(q_),
        s_(q_),
        d_(q_),
        Kd_(q_),
        q0_(q_) {
    measure_stick_area();
  }

  TangentialSolution run() {
    const bool unloaded = problem_.moment.value_or(problem_.twist.value_or(0.0)) == 0.0 &&
                          problem_.initial_displacement.size() == 0;
    if (unloaded || total_friction_ == 0.0) return finish(Status::converged, "");
    // The initial guess, Eq. (13): tractions like a rotation, scaled to the moment, all cells in stick.
    balance_moment();
    for (iteration_ = 1; iteration_ <= options_.max_iterations; ++iteration_) {
      /*  1 */ compute_displacements();
      if (!can_hold()) return failure("empty stick area", "every cell slips");
      /*  2 */ estimate_twist();
      /*  3 */ compute_slip();
      if (!std::isfinite(S_)) return failure("non-finite slip", fmt::format("S = {}", S_));
      /*  4 */ choose_direction();
      /*  5 */ S0_ = S_;
      /*  6 */ find_step_length();
      if (S_ > 0.0 && !(curvature_ > 0.0)) {
        return failure("indefinite operator", fmt::format("d.Kd = {}, S = {}", curvature_, S_));
      }
      /*  7 */ q0_ = q_;           // Eq. (20)
      /*  8 */ q_ -= alpha_ * d_;  // Eq. (21)
      /*  9 */ enforce_coulomb();
      /* 10 */ balance_moment();
      /* 11 */ measure_change();
      if (change_ <= options_.tolerance && within_bounds()) return finish(Status::converged, "");
    }
    iteration_ = options_.max_iterations;
    return finish(
        Status::not_converged,
        fmt::format("too many iterations: change {:.3g} of the sum of mu p after {}, tolerance {:.3g}{}",
                    change_, iteration_, options_.tolerance,
                    within_bounds() ? "" : ", and |q| is above mu p by more than that"));
  }

 private:
  /// Step 1, Eq. (12); by recurrence where no cell changed its state.
  void compute_displacements() {
    const bool recur = !changed_ && iteration_ % kRefresh != 0;
    if (recur) {
      u_ -= alpha_ * Kd_;
    } else {
      op_.apply(q_, u_);
    }
  }

  /// t on A_S and its square sum, the denominator of Eqs. (16) and (25), whenever A_S is new.
  void measure_stick_area() {
    stick_t_ = both(stick_) * t_;
    stick_t_square_ = stick_t_.square().sum();
  }

  /// True if A_S can carry a moment; a single cell on the axis carries none and does not determine the twist.
  bool can_hold() const { return problem_.twist ? stick_.any() : stick_t_square_ > 0.0; }

  /// Step 2, Eqs. (14)-(16): the twist that fits the displacements best on A_S.
  void estimate_twist() {
    phi_ = problem_.twist ? *problem_.twist : (stick_t_ * (u_ + initial_)).sum() / stick_t_square_;
  }

  /// Step 3: relative slip distances, Eq. (8), and their square sum on A_S, Eq. (17).
  void compute_slip() {
    s_ = both(contact_) * (u_ + initial_ - phi_ * t_);
    S_ = (both(stick_) * s_.square()).sum();
  }

  /// Step 4, Eq. (18); after a change of A_S the conjugate directions start afresh.
  void choose_direction() {
    const double theta = changed_ ? 0.0 : 1.0;
    d_ = both(stick_) * (s_ + (S_ * theta / S0_) * d_);
  }

  /// Step 6, Eq. (19).
  void find_step_length() {
    op_.apply(d_, Kd_);
    curvature_ = (d_ * Kd_).sum();
    alpha_ = S_ > 0.0 ? (s_ * d_).sum() / curvature_ : 0.0;
  }

  /// Step 9, Eqs. (22), (23).
  void enforce_coulomb() {
    const Index cells = contact_.size();
    changed_ = false;
    for (Index i = 0; i < cells; ++i) {
      const double bound = problem_.friction_bound[i];
      double& q1 = q_[i];
      double& q2 = q_[i + cells];
      if (stick_[i] != 0.0) {
        const double size = std::hypot(q1, q2);
        if (!(size > bound)) continue;
        q1 *= bound / size;
        q2 *= bound / size;
        stick_[i] = 0.0;
        changed_ = true;
      } else if (contact_[i] != 0.0 && q1 * s_[i] + q2 * s_[i + cells] > 0.0) {
        stick_[i] = 1.0;
        changed_ = true;
      }
    }
    if (changed_) measure_stick_area();
  }

  /// Step 10, Eqs. (24), (25): a multiple of t on A_S restores the moment, where one is given. The directions
  /// carry no moment, so b is rounding unless step 9 changed something.
  void balance_moment() {
    if (!problem_.moment || !can_hold()) return;
    const double b = (*problem_.moment - (q_ * t_).sum()) / stick_t_square_;
    q_ += b * stick_t_;
  }

  /// Step 11, the left side of Eq. (26).
  void measure_change() {
    change_ = norms(q_ - q0_).sum() / total_friction_;
    if (options_.progress && iteration_ % kProgressEvery == 0) options_.progress(iteration_, change_);
  }

  /// Step 10 may raise tractions above the bound that step 9 has enforced. Eq. (26), a sum over all cells,
  /// may not detect it in a few cells.
  bool within_bounds() const {
    return (norms(q_) <= (1.0 + options_.tolerance) * problem_.friction_bound).all();
  }

  TangentialSolution failure(const char* what, const std::string& numbers) {
    return finish(Status::not_converged, fmt::format("{} in iteration {}: {}", what, iteration_, numbers));
  }

  /// The reported displacements are computed from the final tractions, not by the recurrence.
  TangentialSolution finish(Status status, const std::string& message) {
    op_.apply(q_, u_);
    if (problem_.twist || can_hold()) estimate_twist();
    compute_slip();
    return {.status = status,
            .message = message,
            .traction = q_,
            .elastic_displacement = u_,
            .slip = s_,
            .stick = stick_,
            .twist = phi_,
            .change = change_,
            .iterations = iteration_};
  }

  LinearOperator& op_;
  const TangentialProblem& problem_;
  const PaperOptions& options_;
  const ArrayXd t_;        // (-x2, x1)
  const ArrayXd initial_;  // (u1, u2) by the pressure
  const double total_friction_;
  const ArrayXd contact_;  // A_C
  ArrayXd stick_;          // A_S
  ArrayXd stick_t_;        // t on A_S
  double stick_t_square_ = 0.0;
  ArrayXd q_, u_, s_, d_, Kd_, q0_;
  double phi_ = 0.0, S_ = 0.0, S0_ = 1.0, alpha_ = 0.0, curvature_ = 0.0, change_ = 0.0;
  bool changed_ = true;  // whether A_S is new: displacements afresh, theta = 0
  int iteration_ = 0;
};

}  // namespace

TangentialSolution solve_by_paper_method(LinearOperator& op, const TangentialProblem& problem,
                                         const PaperOptions& options) {
  require_valid(problem, op.grid());
  return PaperMethod(op, problem, options).run();
}

}  // namespace slipstick::solver
