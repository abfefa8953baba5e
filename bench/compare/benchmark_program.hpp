#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

/// Programs of Google Benchmark, run one benchmark at a time.
namespace slipstick::bench {

/// How long one run of a benchmark lasts.
struct RunLength {
  double seconds = 0.05;  ///< least timed duration
  int repetitions = 1;
  /// See convergence::ProgramOptions: no run outlasts who started it.
  std::filesystem::path tied_by = {};
};

/// The --benchmark_filter that runs exactly these benchmarks.
std::string benchmark_filter(const std::vector<std::string>& names);

/// The benchmarks of a program of Google Benchmark whose names fit a regular expression (POSIX extended;
/// empty: the program's default), in its order. Throws InputError for a program without benchmarks.
std::vector<std::string> list_benchmarks(const std::filesystem::path& program, const std::string& filter);

/// Runs one benchmark in a process of its own; what it says, in Google Benchmark's JSON. Throws
/// std::runtime_error where it ends otherwise.
nlohmann::ordered_json run_benchmark(const std::filesystem::path& program, const std::string& name,
                                     const RunLength& length);

/// Runs benchmarks of a program one after the other, each in a process of its own; one file of all, in Google
/// Benchmark's JSON. Finished ones are kept in the folder and not run again for the same program and length;
/// an interrupt loses the one being run. Says on standard error how far it is.
nlohmann::ordered_json run_survey(const std::filesystem::path& program, const std::vector<std::string>& names,
                                  const RunLength& length, const std::filesystem::path& folder);

}  // namespace slipstick::bench
