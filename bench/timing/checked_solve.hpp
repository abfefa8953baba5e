#pragma once

#include <string>

#include "convergence/oracle/errors.hpp"
#include "solver/solve.hpp"

namespace slipstick::bench {

/// A solved scene with the errors of its last step against the exact answer.
struct CheckedSolution {
  solver::Solution solution;
  convergence::Errors errors;
  std::string invalid_reason;  ///< why it is no result and must not be timed; empty: none
};

/// Throws InputError where there is no exact answer.
CheckedSolution solve_and_check(const solver::Scene& scene);

/// Why a solution is no result and must not be timed; empty: none. It has not converged, its certificate (but
/// by the paper's method) is worse than the tolerance, or its errors are above what its mesh, its pressure
/// model and its tolerance explain.
std::string invalid_reason(const solver::Scene& scene, const solver::Solution& solution,
                           const convergence::Errors& errors);

}  // namespace slipstick::bench
