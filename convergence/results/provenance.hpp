#pragma once

#include "convergence/results/solve_record.hpp"

namespace slipstick::convergence {

/// Version, commit, compiler, flags and libraries of this program, and the processor that it runs on.
Provenance provenance(int threads);

}  // namespace slipstick::convergence
