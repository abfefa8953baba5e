#include "solver/normal_contact.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// K p by recurrence drifts by rounding; it is computed afresh this often.
constexpr int kRefresh = 50;
/// The load is imposed by scaling, so it can only be off by rounding.
constexpr double kLoadTolerance = 1e-12;

/// Duality gap of the convex program: the energy would fall by no more than this if the load moved to where
/// the surfaces are closest.
double complementarity_gap(const ArrayXd& p, const ArrayXd& u, const ArrayXd& opening) {
  const double lowest = opening.minCoeff();
  double sum = 0.0;
  for (Index i = 0; i < p.size(); ++i) {
    if (p[i] > 0.0) sum += p[i] * (opening[i] - lowest);
  }
  return sum / (0.5 * (p * u).sum());
}

}  // namespace

NormalSolution solve_normal_contact(LinearOperator& op, const NormalProblem& problem,
                                    const NormalOptions& options) {
  const Index cells = problem.gap.size();
  const ArrayXd reachable = problem.gap.isFinite().cast<double>();
  if (!(problem.total_pressure > 0.0) || !std::isfinite(problem.total_pressure)) {
    throw std::invalid_argument(fmt::format("normal load {}: allowed: positive", problem.total_pressure));
  }
  if (reachable.sum() == 0.0 || problem.gap.isNaN().any()) {
    throw std::invalid_argument("the gap is nowhere finite, or not a number");
  }

  NormalSolution solution;
  ArrayXd& p = solution.pressure;
  p = reachable * (problem.total_pressure / reachable.sum());
  ArrayXd u(cells), opening(cells), direction = ArrayXd::Zero(cells), response(cells);
  ArrayXd contact = reachable;  // 1 in contact, 0 outside
  double previous_square = 1.0;
  bool set_changed = true;

  for (solution.iterations = 0; solution.iterations < options.max_iterations; ++solution.iterations) {
    const bool fresh = set_changed || solution.iterations % kRefresh == 0;
    if (fresh) op.apply(p, u);
    opening = u + problem.gap;  // the gap as deformed, up to the rigid approach; infinite where unreachable
    contact = (p > 0.0).cast<double>();
    const double contact_cells = contact.sum();
    solution.approach = (contact > 0.0).select(opening, 0.0).sum() / contact_cells;
    solution.complementarity = complementarity_gap(p, u, opening);
    solution.load_error = std::abs(p.sum() / problem.total_pressure - 1.0);
    if (!std::isfinite(solution.complementarity)) {
      solution.message = fmt::format("non-finite pressure in iteration {}", solution.iterations);
      return solution;
    }
    if (solution.complementarity <= options.tolerance && solution.load_error <= kLoadTolerance) {
      if (!fresh) {  // believe only a residual that was not carried along
        set_changed = true;
        continue;
      }
      solution.status = Status::converged;
      return solution;
    }

    const ArrayXd residual = (contact > 0.0).select(opening - solution.approach, 0.0);
    const double square = residual.square().sum();
    const double beta = set_changed ? 0.0 : square / previous_square;
    previous_square = square;
    direction = residual + beta * contact * direction;
    op.apply(direction, response);
    const double mean_response = (contact * response).sum() / contact_cells;
    const double curvature = (direction * (response - mean_response)).sum();
    if (square > 0.0 && !(curvature > 0.0)) {
      solution.message = fmt::format("curvature {} along the descent direction in iteration {}", curvature,
                                     solution.iterations);
      return solution;
    }
    // With nothing to redistribute inside the contact (one cell, say), a step of the size of 1/compliance is
    // what overlapping neighbours get.
    const double step = square > 0.0 ? (residual * direction).sum() / curvature : p.maxCoeff() / u.maxCoeff();

    p -= step * direction;
    set_changed = (p < 0.0).any();
    p = p.max(0.0);
    // Cells outside whose surfaces overlap come into contact.
    for (Index i = 0; i < cells; ++i) {
      if (p[i] == 0.0 && opening[i] < solution.approach) {
        p[i] = step * (solution.approach - opening[i]);
        set_changed = true;
      }
    }
    const double scale = problem.total_pressure / p.sum();
    p *= scale;
    u = scale * (u - step * response);
  }
  solution.message = fmt::format("complementarity gap {:.3g} after {} iterations, asked for {:.3g}",
                                 solution.complementarity, solution.iterations, options.tolerance);
  return solution;
}

}  // namespace slipstick::solver
