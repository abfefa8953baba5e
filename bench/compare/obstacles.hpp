#pragma once

#include <string>
#include <vector>

#include "bench/compare/comparison.hpp"
#include "bench/timing/timings.hpp"

namespace slipstick::bench {

/// Reasons not to judge the times of two files: different machines, debug builds, load, one file twice. What
/// waits for a processor is a reason in independent runs only; load slows both sides of a pair alike.
std::vector<std::string> find_obstacles(const Timings& base, const Timings& now,
                                        const ComparisonRules& rules);

}  // namespace slipstick::bench
