#include "solver/paper_method.hpp"

#include <fmt/core.h>

#include <cmath>
#include <stdexcept>

#include "solver/certificate.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// K q by recurrence drifts by rounding; it is computed afresh this often.
constexpr int kRefresh = 50;
constexpr int kProgressEvery = 20;

void apply(LinearOperator& op, const ArrayXd& in, ArrayXd& out) {
  op.apply({in.data(), static_cast<std::size_t>(in.size())},
           {out.data(), static_cast<std::size_t>(out.size())});
}

/// A factor a cell, for both components.
ArrayXd both(const ArrayXd& cell_values) { return cell_values.replicate(2, 1); }

void require_valid(const TorsionProblem& problem, double limit) {
  const auto& bound = problem.friction_bound;
  if (!(bound >= 0.0).all() || !bound.isFinite().all()) {
    throw std::invalid_argument("friction bound mu p: allowed: finite, zero or positive in every cell");
  }
  if (problem.moment.has_value() == problem.twist.has_value()) {
    throw std::invalid_argument("torsion: allowed: either a moment or a twist");
  }
  if (problem.moment && *problem.moment != 0.0 && !(std::abs(*problem.moment) < limit)) {
    throw std::invalid_argument(
        fmt::format("moment {} (over the cell area): gross slip; allowed: below {}", *problem.moment, limit));
  }
  if (problem.twist && !std::isfinite(*problem.twist)) throw std::invalid_argument("twist: allowed: finite");
}

/// The state that Section 4 carries from step to step, under the paper's names.
struct Iteration {
  const ArrayXd& bound;  // mu p
  const ArrayXd& t;      // (-x2, x1)
  ArrayXd& q;
  ArrayXd& u;  // K q
  ArrayXd& s;
  ArrayXd& stick;  // A_S
  ArrayXd contact;
  ArrayXd d = {}, Kd = {}, q0 = {};
  double S = 0.0, S0 = 1.0, theta = 0.0, alpha = 0.0;
};

/// Step 2, Eqs. (14)-(16): the twist that fits u best on A_S.
double estimate_twist(const Iteration& it, const ArrayXd& u) {
  const ArrayXd on_stick = both(it.stick) * it.t;
  return (on_stick * u).sum() / on_stick.square().sum();
}

/// Step 9, Eqs. (22), (23). Returns whether any cell changed its state.
bool enforce_coulomb(Iteration& it) {
  const Index cells = it.bound.size();
  bool changed = false;
  for (Index i = 0; i < cells; ++i) {
    double& q1 = it.q[i];
    double& q2 = it.q[i + cells];
    if (it.stick[i] != 0.0) {
      const double size = std::hypot(q1, q2);
      if (size > it.bound[i]) {
        q1 *= it.bound[i] / size;
        q2 *= it.bound[i] / size;
        it.stick[i] = 0.0;
        changed = true;
      }
    } else if (it.contact[i] != 0.0 && q1 * it.s[i] + q2 * it.s[i + cells] > 0.0) {
      it.stick[i] = 1.0;
      changed = true;
    }
  }
  return changed;
}

/// Step 10, Eqs. (24), (25): a multiple of t on A_S restores the moment.
void balance_moment(Iteration& it, double moment) {
  const ArrayXd on_stick = both(it.stick) * it.t;
  const double b = (moment - (it.q * it.t).sum()) / on_stick.square().sum();
  it.q += b * on_stick;
}

}  // namespace

double moment_limit(const Grid& grid, const Eigen::ArrayXd& friction_bound) {
  return (friction_bound * norms(rotation_field(grid))).sum();
}

TorsionSolution solve_by_paper_method(LinearOperator& op, const TorsionProblem& problem,
                                      const PaperOptions& options) {
  const Index cells = op.grid().cells();
  const ArrayXd t = rotation_field(op.grid());
  require_valid(problem, moment_limit(op.grid(), problem.friction_bound));

  const bool has_initial = problem.initial_displacement.size() > 0;
  const ArrayXd initial = has_initial ? problem.initial_displacement : ArrayXd::Zero(2 * cells);
  const double total_friction = problem.friction_bound.sum();
  const bool unloaded = problem.moment.value_or(problem.twist.value_or(0.0)) == 0.0 && !has_initial;

  TorsionSolution out;
  out.traction = out.elastic_displacement = out.slip = ArrayXd::Zero(2 * cells);
  out.stick = (problem.friction_bound > 0.0).cast<double>();
  Iteration it{.bound = problem.friction_bound,
               .t = t,
               .q = out.traction,
               .u = out.elastic_displacement,
               .s = out.slip,
               .stick = out.stick,
               .contact = out.stick};
  it.d = it.Kd = it.q0 = ArrayXd::Zero(2 * cells);

  const auto stop = [&](Status status, const std::string& message) {
    out.status = status;
    out.message = message;
    apply(op, it.q, it.u);  // what is reported of a result is computed from it, not carried along
    const ArrayXd u = it.u + initial;
    if (problem.twist) {
      out.twist = *problem.twist;
    } else if (!unloaded && it.stick.any()) {
      out.twist = estimate_twist(it, u);
    }
    it.s = both(it.contact) * (u - out.twist * t);
    return out;
  };

  if (unloaded || total_friction == 0.0) return stop(Status::converged, "");

  // The initial guess, Eq. (13): tractions like a rotation, scaled to the moment, all cells in stick.
  if (problem.moment) balance_moment(it, *problem.moment);
  bool fresh = true;

  for (out.iterations = 1; out.iterations <= options.max_iterations; ++out.iterations) {
    // 1. Displacements, Eq. (12); by recurrence where no cell changed its state.
    if (fresh || out.iterations % kRefresh == 0) apply(op, it.q, it.u);
    const ArrayXd u = it.u + initial;

    // 2. The angle of torsion, Eq. (16).
    if (!it.stick.any()) {
      return stop(Status::not_converged,
                  fmt::format("empty stick area in iteration {}: every cell slips", out.iterations));
    }
    out.twist = problem.twist ? *problem.twist : estimate_twist(it, u);

    // 3. Relative slip distances, Eq. (8), and their square sum on A_S, Eq. (17).
    it.s = both(it.contact) * (u - out.twist * t);
    it.S = (both(it.stick) * it.s.square()).sum();
    if (!std::isfinite(it.S)) {
      return stop(Status::not_converged,
                  fmt::format("non-finite slip in iteration {}: S = {}", out.iterations, it.S));
    }

    // 4. The descent direction, Eq. (18).
    it.d = both(it.stick) * (it.s + (it.S * it.theta / it.S0) * it.d);

    // 5. Memorise S.
    it.S0 = it.S;

    // 6. The step length, Eq. (19).
    apply(op, it.d, it.Kd);
    const double curvature = (it.d * it.Kd).sum();
    if (it.S > 0.0 && !(curvature > 0.0)) {
      return stop(Status::not_converged, fmt::format("indefinite operator in iteration {}: d.Kd = {}, S = {}",
                                                     out.iterations, curvature, it.S));
    }
    it.alpha = it.S > 0.0 ? (it.s * it.d).sum() / curvature : 0.0;

    // 7. Memorise the current tractions, Eq. (20).
    it.q0 = it.q;

    // 8. Make the step, Eq. (21).
    it.q -= it.alpha * it.d;

    // 9. Coulomb's law in each cell, Eqs. (22), (23); a change of A_S restarts the conjugate directions.
    const bool changed = enforce_coulomb(it);
    it.theta = changed ? 0.0 : 1.0;
    fresh = changed;
    if (!changed) it.u -= it.alpha * it.Kd;

    // 10. Static equilibrium, Eqs. (24), (25). Along d the moment does not change, so b is rounding
    // without 9.
    if (problem.moment && it.stick.any()) balance_moment(it, *problem.moment);

    // 11. Convergence, Eq. (26).
    out.change = norms(it.q - it.q0).sum() / total_friction;
    if (options.progress && out.iterations % kProgressEvery == 0)
      options.progress(out.iterations, out.change);
    if (out.change <= options.tolerance) return stop(Status::converged, "");
  }
  out.iterations = options.max_iterations;
  return stop(
      Status::not_converged,
      fmt::format(
          "too many iterations: change {:.3g} of the sum of mu p after {} iterations, asked for {:.3g}",
          out.change, out.iterations, options.tolerance));
}

}  // namespace slipstick::solver
