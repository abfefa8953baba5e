#include "solver/contact/paper_method.hpp"

#include <fmt/core.h>

#include <cmath>
#include <utility>

#include "solver/contact/certificate.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// K q by recurrence drifts by rounding; it is computed afresh this often.
constexpr int kRefresh = 50;
constexpr int kProgressEvery = 20;

/// A factor a cell, for both components.
ArrayXd both(const ArrayXd& cell_values) { return cell_values.replicate(2, 1); }

/// The constants of a solve, under the paper's names.
struct PaperProblem {
  const TangentialProblem& problem;
  ArrayXd t;                     ///< (-x2, x1)
  ArrayXd initial_displacement;  ///< (u1, u2) by the pressure
  ArrayXd contact;               ///< A_C: 1 or 0 in each cell
  double total_friction;
};

PaperProblem paper_problem(const TangentialProblem& problem, const Grid& grid) {
  return {.problem = problem,
          .t = rotation_field(grid),
          .initial_displacement =
              problem.initial_displacement.size() > 0 ? problem.initial_displacement : ArrayXd::Zero(2 * grid.cells()),
          .contact = (problem.friction_bound > 0.0).cast<double>(),
          .total_friction = problem.friction_bound.sum()};
}

/// A_S, t on it, and the square sum of that, the denominator of Eqs. (16) and (25).
struct StickArea {
  ArrayXd cells;
  ArrayXd t;
  double t_square;
};

StickArea stick_area_of(ArrayXd cells, const ArrayXd& t) {
  ArrayXd on_cells = both(cells) * t;
  const double square = on_cells.square().sum();
  return {std::move(cells), std::move(on_cells), square};
}

/// True if A_S can carry a moment; a single cell on the axis carries none and does not determine the twist.
bool can_hold(const StickArea& stick, const TangentialProblem& problem) {
  return problem.twist ? stick.cells.any() : stick.t_square > 0.0;
}

/// Tractions q, displacements u = K q, slip s, twist phi, and the square sum S of the slip on A_S.
struct PaperState {
  ArrayXd q, u, s = {};
  double phi = 0.0, S = 0.0;
};

/// The direction d of a step, K d, and the step's length.
struct ConjugateStep {
  ArrayXd d, Kd;
  double curvature = 0.0, alpha = 0.0;
};

/// Why and where the iteration ended. change: of the last iteration, the left side of Eq. (26).
struct PaperEnding {
  Status status;
  std::string message;
  double change = 0.0;
  int iterations = 0;
};

/// Step 2, Eqs. (14)-(16): the twist that fits the displacements best on A_S.
double fitted_twist(const PaperProblem& given, const StickArea& stick, const ArrayXd& u) {
  if (given.problem.twist) return *given.problem.twist;
  return (stick.t * (u + given.initial_displacement)).sum() / stick.t_square;
}

/// Step 3: relative slip distances, Eq. (8), and their square sum on A_S, Eq. (17).
void compute_slip(const PaperProblem& given, const StickArea& stick, PaperState& at) {
  at.s = both(given.contact) * (at.u + given.initial_displacement - at.phi * given.t);
  at.S = (both(stick.cells) * at.s.square()).sum();
}

/// Step 6, Eq. (19).
void find_step_length(LinearOperator& op, const PaperState& at, ConjugateStep& step) {
  op.apply(step.d, step.Kd);
  step.curvature = (step.d * step.Kd).sum();
  step.alpha = at.S > 0.0 ? (at.s * step.d).sum() / step.curvature : 0.0;
}

/// Step 9, Eqs. (22), (23). Returns whether A_S has changed.
bool enforce_coulomb(const PaperProblem& given, StickArea& stick, PaperState& at) {
  const Index cells = given.contact.size();
  bool changed = false;
  for (Index i = 0; i < cells; ++i) {
    const double bound = given.problem.friction_bound[i];
    double& q1 = at.q[i];
    double& q2 = at.q[i + cells];
    if (stick.cells[i] != 0.0) {
      const double size = std::hypot(q1, q2);
      if (!(size > bound)) continue;
      q1 *= bound / size;
      q2 *= bound / size;
      stick.cells[i] = 0.0;
      changed = true;
    } else if (given.contact[i] != 0.0 && q1 * at.s[i] + q2 * at.s[i + cells] > 0.0) {
      stick.cells[i] = 1.0;
      changed = true;
    }
  }
  if (changed) stick = stick_area_of(std::move(stick.cells), given.t);
  return changed;
}

/// Step 10, Eqs. (24), (25): a multiple of t on A_S restores the moment, where one is given. The directions
/// carry no moment, so b is rounding unless step 9 changed something.
void balance_moment(const PaperProblem& given, const StickArea& stick, ArrayXd& q) {
  if (!given.problem.moment || !can_hold(stick, given.problem)) return;
  const double b = (*given.problem.moment - (q * given.t).sum()) / stick.t_square;
  q += b * stick.t;
}

/// Step 10 may raise tractions above the bound that step 9 has enforced. Eq. (26), a sum over all cells, may
/// not detect it in a few cells.
bool within_bounds(const PaperProblem& given, const ArrayXd& q, double tolerance) {
  return (norms(q) <= (1.0 + tolerance) * given.problem.friction_bound).all();
}

/// Section 4 of the paper, with the numbers of its steps.
PaperEnding iterate(LinearOperator& op, const PaperProblem& given, const PaperOptions& options, StickArea& stick,
                    PaperState& at) {
  ConjugateStep step{at.q, at.q};
  ArrayXd q0;
  double S0 = 1.0;
  double change = 0.0;
  bool changed = true;  // whether A_S is new: displacements afresh, theta = 0
  const auto failure = [&](const char* what, int iteration, const std::string& numbers) -> PaperEnding {
    return {Status::not_converged, fmt::format("{} in iteration {}: {}", what, iteration, numbers), change, iteration};
  };
  // The initial guess, Eq. (13): tractions like a rotation, scaled to the moment, all cells in stick.
  balance_moment(given, stick, at.q);
  for (int iteration = 1; iteration <= options.max_iterations; ++iteration) {
    // 1, Eq. (12); by recurrence where no cell changed its state.
    if (!changed && iteration % kRefresh != 0) {
      at.u -= step.alpha * step.Kd;
    } else {
      op.apply(at.q, at.u);
    }
    if (!can_hold(stick, given.problem)) return failure("empty stick area", iteration, "every cell slips");
    /*  2 */ at.phi = fitted_twist(given, stick, at.u);
    /*  3 */ compute_slip(given, stick, at);
    if (!std::isfinite(at.S)) return failure("non-finite slip", iteration, fmt::format("S = {}", at.S));
    // 4, Eq. (18); after a change of A_S the conjugate directions start afresh.
    const double theta = changed ? 0.0 : 1.0;
    step.d = both(stick.cells) * (at.s + (at.S * theta / S0) * step.d);
    /*  5 */ S0 = at.S;
    /*  6 */ find_step_length(op, at, step);
    if (at.S > 0.0 && !(step.curvature > 0.0)) {
      return failure("indefinite operator", iteration, fmt::format("d.Kd = {}, S = {}", step.curvature, at.S));
    }
    /*  7 */ q0 = at.q;                    // Eq. (20)
    /*  8 */ at.q -= step.alpha * step.d;  // Eq. (21)
    /*  9 */ changed = enforce_coulomb(given, stick, at);
    /* 10 */ balance_moment(given, stick, at.q);
    /* 11 */ change = norms(at.q - q0).sum() / given.total_friction;
    if (options.progress && iteration % kProgressEvery == 0) options.progress(iteration, change);
    if (change <= options.tolerance && within_bounds(given, at.q, options.tolerance))
      return {Status::converged, "", change, iteration};
  }
  return {Status::not_converged,
          fmt::format("too many iterations: change {:.3g} of the sum of mu p after {}, tolerance {:.3g}{}", change,
                      options.max_iterations, options.tolerance,
                      within_bounds(given, at.q, options.tolerance) ? "" : ", and |q| is above mu p by more than that"),
          change, options.max_iterations};
}

}  // namespace

TangentialSolution solve_by_paper_method(LinearOperator& op, const TangentialProblem& problem,
                                         const PaperOptions& options) {
  require_valid(problem, op.grid());
  const PaperProblem given = paper_problem(problem, op.grid());
  StickArea stick = stick_area_of(given.contact, given.t);
  PaperState at{.q = ArrayXd::Zero(given.t.size()), .u = ArrayXd::Zero(given.t.size())};
  const bool unloaded =
      problem.moment.value_or(problem.twist.value_or(0.0)) == 0.0 && problem.initial_displacement.size() == 0;
  const bool solved = unloaded || given.total_friction == 0.0;
  PaperEnding ending = solved ? PaperEnding{Status::converged, ""} : iterate(op, given, options, stick, at);
  // The reported displacements are computed from the final tractions, not by the recurrence.
  op.apply(at.q, at.u);
  if (problem.twist || can_hold(stick, problem)) at.phi = fitted_twist(given, stick, at.u);
  compute_slip(given, stick, at);
  return {.status = ending.status,
          .message = std::move(ending.message),
          .traction = std::move(at.q),
          .elastic_displacement = std::move(at.u),
          .slip = std::move(at.s),
          .stick = std::move(stick.cells),
          .twist = at.phi,
          .change = ending.change,
          .iterations = ending.iterations};
}

}  // namespace slipstick::solver
