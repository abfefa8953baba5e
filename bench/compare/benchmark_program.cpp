#include "bench/compare/benchmark_program.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "bench/timing/timings.hpp"
#include "convergence/programs/temporary_folder.hpp"
#include "convergence/runs/progress.hpp"
#include "convergence/runs/result_cache.hpp"
#include "convergence/runs/run_spec.hpp"
#include "convergence/system/run_program.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::bench {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using namespace convergence;

/// A path that is not looked up on PATH.
std::string program_word(const fs::path& program) { return fs::absolute(program).string(); }

/// A readable and unique file name for the benchmark.
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

std::string benchmark_filter(const std::vector<std::string>& names) {
  std::vector<std::string> escaped;
  for (const std::string& name : names) {
    std::string& pattern = escaped.emplace_back();
    for (const char c : name) {
      if (std::string_view(".[]{}()*+?|^$\\").find(c) != std::string_view::npos) pattern += '\\';
      pattern += c;
    }
  }
  return fmt::format("^({})$", fmt::join(escaped, "|"));
}

std::vector<std::string> list_benchmarks(const fs::path& program, const std::string& filter) {
  if (!fs::is_regular_file(program)) {
    throw solver::InputError(program.string(), "there is no such program; allowed: one of Google Benchmark");
  }
  std::vector<std::string> words{program_word(program), "--benchmark_list_tests"};
  if (!filter.empty()) words.push_back(fmt::format("--benchmark_filter={}", filter));
  const ProgramEnd end = run_program(words, {.captured = Captured::output});
  std::vector<std::string> names;
  std::istringstream lines(end.output);
  for (std::string line; std::getline(lines, line);) names.push_back(line);
  if (end.code != 0 || names.empty()) {
    throw solver::InputError(program.string(), fmt::format("lists no benchmark that fits \"{}\"", filter));
  }
  return names;
}

Json run_benchmark(const fs::path& program, const std::string& name, const RunLength& length) {
  const TemporaryFolder folder;
  const fs::path out = folder / "timings.json";
  const ProgramEnd end =
      run_program({program_word(program), fmt::format("--benchmark_filter={}", benchmark_filter({name})),
                   fmt::format("--benchmark_out={}", out.string()), "--benchmark_out_format=json",
                   fmt::format("--benchmark_min_time={}", length.seconds),
                   fmt::format("--benchmark_repetitions={}", length.repetitions)},
                  {.captured = Captured::everything, .tied_by = length.tied_by});
  if (end.code != 0) {
    throw std::runtime_error(fmt::format("{}: benchmark {} {}", program.string(), name, end.trouble));
  }
  return parse_benchmark_json(convergence::read_text(out),
                              fmt::format("{}: benchmark {}", program.string(), name));
}

Json run_survey(const fs::path& program, const std::vector<std::string>& names, const RunLength& length,
                const fs::path& folder) {
  const convergence::ResultCache cache(folder);
  convergence::Progress progress(names.size(), static_cast<double>(names.size()));
  Json file;
  for (const std::string& name : names) {
    const std::string key = cache_key(program, name, length);
    std::optional<Json> run = cache.find(file_name(name), key);
    if (!run) cache.keep(file_name(name), key, run.emplace(run_benchmark(program, name, length)));
    if (file.is_null()) file = {{"context", run->at("context")}, {"benchmarks", Json::array()}};
    for (const Json& row : run->at("benchmarks")) file["benchmarks"].push_back(row);
    progress.finished(name, 1.0);
  }
  return file;
}

}  // namespace slipstick::bench
