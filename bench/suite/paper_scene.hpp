#pragma once

#include "bench/suite/suite.hpp"
#include "bench/timing/checked_solve.hpp"

namespace slipstick::bench {

/// The paper's scene on cells x cells cells under a part of the limit moment: Coulomb's method, nothing left
/// out of the model, solved pressure, one thread, tolerance 1e-8.
solver::Scene paper_scene(solver::Index cells, double moment_ratio);

/// Errors, certificate, work and memory.
std::map<std::string, benchmark::Counter> counters(const CheckedSolution& checked);

}  // namespace slipstick::bench
