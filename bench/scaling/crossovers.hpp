#pragma once

#include <string>

#include "convergence/results/result_parts.hpp"

namespace slipstick::bench {

/// The sizes from which dcfft is quicker than the other operators. seconds: of each family of benchmarks the
/// pairs of cells along a side and repetitions.
convergence::Json crossovers(const convergence::Json& seconds);

/// The crossovers for a person.
std::string crossovers_text(const convergence::Json& crossovers);

}  // namespace slipstick::bench
