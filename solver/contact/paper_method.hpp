#pragma once

#include "solver/contact/tangential_problem.hpp"
#include "solver/elasticity/linear_operator.hpp"
#include "solver/newton/safeguards.hpp"

namespace slipstick::solver {

struct PaperOptions {
  double tolerance = 1e-8;  ///< epsilon of Eq. (26) over the sum of mu p
  int max_iterations = 5000;
  Progress progress = {};  ///< iterations and the change of Eq. (26)
};

/// The algorithm of Gradinaru and Spinu, Section 4, step by step (see the source), with two corrections: the rotation
/// field is (-x2, x1), and the denominators have the sums that the print lacks. It also continues while some |q|
/// exceeds mu p by more than the tolerance, which Eq. (26) may not detect. As published, a cell that begins to slip
/// keeps the direction of its traction (Eqs. (22), (23)), so that on contacts that are not circular the certificate
/// stays large. With an imposed twist, the steps that find the twist and balance the moment are omitted.
///
/// Throws std::invalid_argument for a problem that require_valid() rejects. A failure of the iteration is a
/// status with its reason.
TangentialSolution solve_by_paper_method(LinearOperator& op, const TangentialProblem& problem,
                                         const PaperOptions& options = {});

}  // namespace slipstick::solver
