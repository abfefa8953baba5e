#pragma once

#include <Eigen/Core>

#include "solver/contact/certificate.hpp"
#include "solver/contact/tangential_problem.hpp"
#include "solver/elasticity/linear_operator.hpp"
#include "solver/newton/admissible.hpp"
#include "solver/newton/load_balance.hpp"

namespace example {

namespace solver = slipstick::solver;

using Eigen::ArrayXd;

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

/// Coulomb's law under a moment or a twist about the origin: steps down the gradient of q.Kq/2 + g.q -
/// phi t.q, each projected back onto the friction discs, and onto the moment, whose multiplier is phi/L. g:
/// displacements by the pressure. Stops on the gap of the certificate.
inline solver::TangentialSolution solve_by_plain_gradient(solver::LinearOperator& op,
                                                          const solver::TangentialProblem& problem, double tolerance,
                                                          int max_iterations) {
  solver::require_valid(problem, op.grid());
  const ArrayXd t = solver::rotation_field(op.grid());
  const ArrayXd contact = (problem.friction_bound > 0.0).cast<double>().replicate(2, 1);
  const ArrayXd g = problem.initial_displacement.size() > 0 ? problem.initial_displacement : 0.0 * t;
  const double L = stiffest(op, contact);
  const solver::MotionField rotation(op.grid(), 0.0, 0.0, 1.0);
  const solver::FrictionDiscs discs(op.grid(), problem.friction_bound);
  const double moment = problem.moment.value_or(0.0);
  const solver::LoadBalance balance(discs, {{&rotation, moment}});
  solver::Coefficients multiplier = solver::Coefficients::Constant(1, problem.twist.value_or(0.0) / L);
  solver::TangentialSolution solution;
  ArrayXd q = 0.0 * t;
  ArrayXd u = q;
  for (int i = 1; i <= max_iterations && solution.status != solver::Status::converged; ++i) {
    q -= (u + g) / L;
    if (problem.moment && !balance.solve(q, multiplier)) break;
    balance.add(multiplier, q);
    discs.project(q);
    op.apply(q, u);
    solution.twist = L * multiplier[0];
    solution.slip = contact * (u + g - solution.twist * t);
    solution.iterations = i;
    solution.change = solver::certify({q, u, solution.slip}, problem.friction_bound, t, moment).gap;
    if (solution.change <= tolerance) solution.status = solver::Status::converged;
  }
  if (solution.status != solver::Status::converged) solution.message = "too many iterations";
  const ArrayXd next = solver::norms(q - solution.slip / L);
  solution.stick = (problem.friction_bound > 0.0 && next <= problem.friction_bound).cast<double>();
  solution.traction = q;
  solution.elastic_displacement = u;
  return solution;
}

}  // namespace example
