#pragma once

#include "solver/contact/tangential_problem.hpp"
#include "solver/elasticity/linear_operator.hpp"
#include "solver/newton/safeguards.hpp"

namespace slipstick::solver {

struct ProjectedGradientOptions {
  double tolerance = 1e-8;  ///< on the gap of the certificate, relative to q.Kq/2
  int max_iterations = 20000;
  Eigen::ArrayXd start;    ///< tractions to begin with, projected first; empty: none
  Progress progress = {};  ///< iterations and the certificate's gap
};

/// Coulomb's law as the minimum of q.Kq/2 + g.q (less phi t.q where the twist phi is imposed) over the
/// friction discs |q| <= mu p and, where it is given, the moment t.q = M: by accelerated projected gradients
/// with adaptive restart (Nesterov 1983; Beck and Teboulle 2009; O'Donoghue and Candes 2015, both schemes).
/// No preconditioner, no active sets, nothing to tune: slow and dependable, one application an iteration,
/// every iterate admissible. g: displacements by the pressure.
///
/// Stops on the gap of certify(), evaluated from an application to the very tractions that are returned,
/// which is also the solution's `change`. A cell sticks if the next step would leave it within its disc.
///
/// Throws std::invalid_argument for a problem that require_valid() refuses and for a start of another size.
/// Everything that the numbers do is a status with its reason.
TangentialSolution solve_by_projected_gradient(LinearOperator& op, const TangentialProblem& problem,
                                               const ProjectedGradientOptions& options = {});

}  // namespace slipstick::solver
