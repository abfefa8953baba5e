#pragma once

#include <string>
#include <vector>

#include "bench/compare/comparison.hpp"
#include "bench/timing/timings.hpp"

namespace slipstick::bench {

/// Reasons not to judge the times of two files.
struct Obstacles {
  std::vector<std::string> obstacles;  ///< times cannot be judged: different machines, debug builds, load
  std::vector<std::string> remarks;    ///< they can be, but a reader must know it
};

Obstacles find_obstacles(const Timings& base, const Timings& now, const ComparisonRules& rules);

/// Benchmarks in one thread whose time by the clock is clearly longer than the processor's: they wait for a
/// processor that others use, or by what they do.
std::vector<std::string> waiting_benchmarks(const Timings& timings);

}  // namespace slipstick::bench
