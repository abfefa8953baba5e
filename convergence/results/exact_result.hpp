#pragma once

#include "convergence/oracle/oracle.hpp"
#include "convergence/results/solve_record.hpp"
#include "solver/scene/scene.hpp"

/// The result of a scene with solver.model = "exact".
namespace slipstick::convergence {

/// The scene's exact answer. Throws InputError, with the reason and the allowed values, where there is none.
Oracle require_oracle(const solver::Scene& scene);

/// Its record; a number that does not exist without a grid is missing. seconds: s, in which it was found.
SolveRecord exact_record(const solver::Scene& scene, const Oracle& oracle, double seconds);

}  // namespace slipstick::convergence
