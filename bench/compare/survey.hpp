#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bench/compare/benchmark_program.hpp"

namespace slipstick::bench {

/// Runs benchmarks of a program one after the other, each in a process of its own; one file of all, in Google
/// Benchmark's JSON. Finished ones are kept in the folder and not run again for the same program and length;
/// an interrupt loses the one being run. Says on standard error how far it is.
nlohmann::ordered_json run_survey(const std::filesystem::path& program, const std::vector<std::string>& names,
                                  const RunLength& length, const std::filesystem::path& folder);

}  // namespace slipstick::bench
