#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/compare/benchmark_program.hpp"
#include "bench/compare/comparison_report.hpp"

/// Two builds, or two methods of one build, run in interleaved pairs and compared.
namespace slipstick::bench {

/// A benchmark of a program; empty: there is none, and nothing is run.
struct ProgramBenchmark {
  std::filesystem::path program;
  std::string benchmark;
};

/// The base program and the compared one, run in immediate succession.
struct InterleavedPair {
  std::string name;  ///< under which they are compared
  std::array<ProgramBenchmark, 2> sides;
};

/// Every benchmark that fits the filter in either program, by its name; a benchmark of one program only has
/// no partner.
std::vector<InterleavedPair> two_builds(const std::filesystem::path& base, const std::filesystem::path& now,
                                        const std::string& filter);

/// Two benchmarks of one program; they are compared under both names. Throws InputError for one that it does
/// not have.
std::vector<InterleavedPair> two_methods(const std::filesystem::path& program, const std::string& base,
                                         const std::string& now);

/// The base's file and the new one of a session, in Google Benchmark's JSON, a repetition a round; both with
/// the same "session" in their context.
using SessionFiles = std::array<nlohmann::ordered_json, 2>;

/// Runs all pairs, `rounds` times, every other time in the reverse order (AB, BA, AB...), so that other load
/// of the machine affects both. Prints its progress on standard error.
SessionFiles run_session(const std::vector<InterleavedPair>& pairs, int rounds, const RunLength& length = {});

struct ABRunResult {
  ComparisonReport report;
  SessionFiles files;  ///< the first session's
};

/// Runs a session, and a second one with twice the rounds for the benchmarks that look slower: a verdict
/// counts if both agree.
ABRunResult run_ab(const std::vector<InterleavedPair>& pairs, int rounds, const ComparisonRules& rules = {},
                   const RunLength& length = {});

}  // namespace slipstick::bench
