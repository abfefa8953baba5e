#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/compare/comparison_report.hpp"
#include "bench/timing/timings.hpp"

namespace slipstick::bench {

struct TwoTimings {
  Timings base;
  Timings now;
};
/// Times some benchmarks once more.
using Again = std::function<TwoTimings(const std::vector<std::string>& names)>;

/// Compares, and states the power; what is suspicious once more, where `again` is not empty: only what both
/// runs say counts. A second run that throws InputError leaves it undecided.
ComparisonReport compare_twice(const TwoTimings& first, const ComparisonRules& rules, const Again& again);

/// Runs a command by the shell, {filter} in it replaced by the filter of these benchmarks, ready for the
/// shell, and reads the JSON that it writes on standard output. Throws InputError naming the command where
/// {filter} stands in quotes, the command fails, or it writes something else.
Timings run_again(const std::string& command, const std::vector<std::string>& names);

}  // namespace slipstick::bench
