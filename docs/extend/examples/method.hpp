#pragma once

#include <Eigen/Core>

#include "solver/contact/certificate.hpp"
#include "solver/contact/tangential_problem.hpp"
#include "solver/elasticity/linear_operator.hpp"

namespace example {

namespace solver = slipstick::solver;

using Eigen::ArrayXd;

/// Each cell's traction, shortened to mu p where it is longer.
inline ArrayXd onto_discs(const ArrayXd& q, const ArrayXd& bound) {
  const ArrayXd size = solver::norms(q).max(1e-300);
  return q * (bound / size).min(1.0).replicate(2, 1);
}

/// The largest eigenvalue of K on the contact, by power iterations, and a little more.
inline double stiffest(solver::LinearOperator& op, const ArrayXd& contact) {
  ArrayXd v = contact * (1.0 + solver::rotation_field(op.grid()));
  ArrayXd Kv(v.size());
  double largest = 0.0;
  for (int i = 0; i < 20; ++i) {
    v /= v.matrix().norm();
    op.apply(v, Kv);
    v = contact * Kv;
    largest = v.matrix().norm();
  }
  return 1.1 * largest;
}

/// Coulomb's law under an imposed twist: steps down the gradient of q.Kq/2 - phi t.q, each projected back
/// onto the friction discs. Stops on the gap of the certificate.
inline solver::TangentialSolution solve_by_plain_gradient(solver::LinearOperator& op,
                                                          const solver::TangentialProblem& problem,
                                                          double tolerance, int max_iterations) {
  solver::require_valid(problem, op.grid());
  const ArrayXd t = solver::rotation_field(op.grid());
  const ArrayXd contact = (problem.friction_bound > 0.0).cast<double>().replicate(2, 1);
  const double step = 1.0 / stiffest(op, contact);
  solver::TangentialSolution solution;
  solution.twist = *problem.twist;
  ArrayXd q = ArrayXd::Zero(t.size());
  ArrayXd u = q;
  for (int i = 1; i <= max_iterations; ++i) {
    q = onto_discs(contact * (q - step * (u - solution.twist * t)), problem.friction_bound);
    op.apply(q, u);
    solution.slip = contact * (u - solution.twist * t);
    solution.iterations = i;
    solution.change = solver::certify({q, u, solution.slip}, problem.friction_bound, t, 0.0).gap;
    if (solution.change <= tolerance) {
      solution.status = solver::Status::converged;
      break;
    }
  }
  if (solution.status != solver::Status::converged) solution.message = "too many iterations";
  const ArrayXd next = solver::norms(q - step * solution.slip);
  solution.stick = (problem.friction_bound > 0.0 && next <= problem.friction_bound).cast<double>();
  solution.traction = q;
  solution.elastic_displacement = u;
  return solution;
}

}  // namespace example
