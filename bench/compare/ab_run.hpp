#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/compare/comparison_report.hpp"
#include "bench/compare/rounds.hpp"

/// Two builds, or two methods of one build, timed in turn in one sitting and compared.
namespace slipstick::bench {

/// A sitting: what is run, how often, and what counts as a difference.
struct Contest {
  std::vector<Heat> heats;  ///< the base first
  int rounds = 16;
  RunLength length = {};
  ComparisonRules rules = {};
};

/// Every benchmark that fits the filter in either program, by its name: those in one only have nothing beside
/// them.
std::vector<Heat> two_builds(const std::filesystem::path& base, const std::filesystem::path& now,
                             const std::string& filter);

/// Two benchmarks of one program; they are compared under both names. Throws InputError for one that it does
/// not have.
std::vector<Heat> two_methods(const std::filesystem::path& program, const std::string& base,
                              const std::string& now);

struct ContestResult {
  ComparisonReport report;
  Sitting first;  ///< the first run's files, the base's first
};

/// Runs a contest, and what is suspicious then once more, twice as often: only what both runs say counts.
ContestResult hold_contest(const Contest& contest);

}  // namespace slipstick::bench
