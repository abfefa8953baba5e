#pragma once

#include <string>

#include "bench/suite/suite.hpp"
#include "convergence/oracle/errors.hpp"
#include "solver/solve.hpp"

namespace slipstick::bench {

/// A solved scene with its errors against the exact answer.
struct CheckedSolution {
  solver::Solution solution;
  convergence::Errors errors;
  std::string invalid_reason;  ///< why it is no result and must not be timed; empty: none
};

/// The paper's scene on cells x cells cells under a part of the limit moment: Coulomb's method, nothing left
/// out of the model, solved pressure, one thread, tolerance 1e-8.
solver::Scene paper_scene(solver::Index cells, double moment_ratio);

/// The errors are those of the last step, see invalid_reason(). Throws InputError where there is no exact
/// answer.
CheckedSolution solve_and_check(const solver::Scene& scene);

/// Errors, certificate, work and memory.
std::map<std::string, benchmark::Counter> counters(const CheckedSolution& checked);

}  // namespace slipstick::bench
