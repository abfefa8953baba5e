#pragma once

#include <fmt/core.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace slipstick::bench::testing {

/// A program that behaves as Google Benchmark's do, with a list of benchmarks ("f\\ng\\n") that all take so
/// long; it notes each of its runs as "label filter" in the file "log" of the folder.
inline std::filesystem::path made_program(const std::filesystem::path& folder, const std::string& label,
                                          const std::string& list, double milliseconds = 1.0,
                                          int exit_code = 0) {
  namespace fs = std::filesystem;
  const fs::path program = folder / label;
  std::ofstream(program) << fmt::format(R"(#!/bin/sh
for word in "$@"; do
  case "$word" in
    --benchmark_list_tests) printf '{1}'; exit 0;;
    --benchmark_filter=*) filter="${{word#*=}}";;
    --benchmark_out=*) out="${{word#*=}}";;
  esac
done
echo "{0} $filter" >> '{2}'
cat > "$out" <<END
{{"context": {{"num_cpus": 2, "build_type": "release"}}, "benchmarks": [
 {{"name": "x", "run_name": "x", "run_type": "iteration", "real_time": {4}, "cpu_time": {4}, "time_unit": "ms"}},
 {{"name": "x_mean", "run_name": "x", "run_type": "aggregate", "real_time": {4}, "cpu_time": {4}, "time_unit": "ms"}}]}}
END
exit {3}
)",
                                        label, list, (folder / "log").string(), exit_code, milliseconds);
  fs::permissions(program, fs::perms::owner_all);
  return program;
}

inline std::vector<std::string> lines_of(const std::filesystem::path& file) {
  std::vector<std::string> lines;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace slipstick::bench::testing
