#pragma once

#include "solver/step/solve_step.hpp"

namespace slipstick::solver {

/// The numbers of a step in SI units.
StepNumbers to_si(StepNumbers numbers, const Model& model);

/// The answer to a step in SI units: its fields and numbers, each times its unit. Throws std::domain_error
/// where that leaves double precision.
Solution to_si(StepResult result, const Model& model);

}  // namespace slipstick::solver
