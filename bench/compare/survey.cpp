#include "bench/compare/survey.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <nlohmann/json.hpp>

#include "convergence/runs/progress.hpp"
#include "convergence/runs/result_cache.hpp"

namespace slipstick::bench {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// The name as that of a file: readable, and its own.
std::string file_name(const std::string& benchmark) {
  std::string name = benchmark;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '-');
  return fmt::format("{}-{:016x}", name.substr(0, 80), std::hash<std::string>{}(benchmark));
}

/// Everything that the timings depend on.
std::string cache_key(const fs::path& program, const std::string& name, const RunLength& length) {
  return fmt::format("{} of {} bytes, written at {}: {} for {} s, {} times", fs::absolute(program).string(),
                     fs::file_size(program), fs::last_write_time(program).time_since_epoch().count(), name,
                     length.seconds, length.repetitions);
}

}  // namespace

Json run_survey(const fs::path& program, const std::vector<std::string>& names, const RunLength& length,
                const fs::path& folder) {
  const convergence::ResultCache cache(folder);
  convergence::Progress progress(names.size(), static_cast<double>(names.size()));
  Json file;
  for (const std::string& name : names) {
    const Json run = cache.find_or_compute(file_name(name), cache_key(program, name, length),
                                           [&] { return run_benchmark(program, name, length); });
    if (file.is_null()) file = {{"context", run.at("context")}, {"benchmarks", Json::array()}};
    for (const Json& row : run.at("benchmarks")) file["benchmarks"].push_back(row);
    progress.finished(name, 1.0);
  }
  return file;
}

}  // namespace slipstick::bench
