#pragma once

#include "solver/contact/tangential_problem.hpp"
#include "solver/elasticity/linear_operator.hpp"
#include "solver/newton/progress.hpp"

namespace slipstick::solver {

struct PaperOptions {
  double tolerance = 1e-8;  ///< epsilon of Eq. (26) over the sum of mu p
  int max_iterations = 5000;
  Progress progress = {};  ///< iterations and the change of Eq. (26)
};

/// The algorithm of Gradinaru and Spinu, Section 4, step by step, with the rotation field (-x2, x1) and the
/// sums in the denominators that the print lacks. It goes on while some |q| is above mu p by more than the
/// tolerance, which Eq. (26) may not see. Nothing else is corrected: a cell that begins to slip keeps the
/// direction its traction had then (Eqs. (22), (23)), so on contacts that are not circular the certificate of
/// the result stays bad. With the twist imposed, the steps that find the twist and balance the moment fall
/// away.
///
/// Throws std::invalid_argument for a problem that require_valid() refuses. Everything that the numbers do is
/// a status with its reason.
TangentialSolution solve_by_paper_method(LinearOperator& op, const TangentialProblem& problem,
                                         const PaperOptions& options = {});

}  // namespace slipstick::solver
