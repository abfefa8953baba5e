#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bench/timing/timings.hpp"

namespace slipstick::bench {

/// All of this of the benchmarks whose names hold "cells:N" (what is left of the name is the family's): rows,
/// power laws, growths beside what theory says, and where dcfft overtakes the other operators.
nlohmann::ordered_json scaling_json(const Timings& timings);

/// The crossovers for a person.
std::string crossovers_text(const nlohmann::ordered_json& scaling);

}  // namespace slipstick::bench
