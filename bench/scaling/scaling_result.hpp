#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bench/timing/timings.hpp"

namespace slipstick::bench {

/// Results of the benchmarks whose names have "cells:N" (the rest of the name is the family): rows, power
/// laws, measured and theoretical growth, and the size from which dcfft is quicker than the other operators.
nlohmann::ordered_json scaling_json(const Timings& timings);

/// The crossovers for a person.
std::string crossovers_text(const nlohmann::ordered_json& scaling);

}  // namespace slipstick::bench
