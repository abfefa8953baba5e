#pragma once

#include <string>

#include "convergence/results/solve_record.hpp"
#include "solver/input/units.hpp"

namespace slipstick::convergence {

/// The answer of a solve in a few lines for a person, in the units of the scene's file.
std::string solve_text(const SolveRecord& record, const solver::Units& units = solver::Units());

/// The angle between slip and traction that the law prescribes, in words.
std::string right_direction_text(solver::FrictionKind law);

}  // namespace slipstick::convergence
