#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/compare/comparison_report.hpp"
#include "bench/timing/timings.hpp"

namespace slipstick::bench {

/// Times some benchmarks once more.
using Again = std::function<TwoTimings(const std::vector<std::string>& names)>;

/// Compares, states the power, and runs suspicious benchmarks a second time where `again` is not empty: only
/// a verdict of both runs counts. A second run that throws InputError leaves them undecided.
ComparisonReport compare_twice(const TwoTimings& first, const ComparisonRules& rules, const Again& again);

/// Runs a command by the shell, {filter} in it replaced by the filter of these benchmarks, ready for the
/// shell, and reads the JSON that it writes on standard output. Throws InputError naming the command where
/// {filter} stands in quotes, the command fails, or it writes something else.
Timings run_again(const std::string& command, const std::vector<std::string>& names);

}  // namespace slipstick::bench
