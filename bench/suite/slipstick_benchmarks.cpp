// The program. Names read family/variant/cells:N; each time is printed with the error of its result, and
// wrong results are reported and not timed. Benchmarks named long/... run only if a filter selects them.

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>

#include "bench/suite/suite.hpp"
#include "convergence/results/provenance.hpp"

namespace {

/// Defaults; the arguments of the command line come later and win.
constexpr std::array kDefaults{"--benchmark_min_time=0.1", "--benchmark_filter=-^long/"};

void say_where_times_come_from() {
#if defined(NDEBUG) && defined(__OPTIMIZE__)
  benchmark::AddCustomContext("build_type", "release");
#else
  benchmark::AddCustomContext("build_type", "debug");
#endif
  const slipstick::convergence::Json provenance = slipstick::convergence::provenance(1);
  for (const auto& [key, value] : provenance.items()) {
    if (value.is_string()) benchmark::AddCustomContext(key, value.get<std::string>());
  }
}

/// The program's own arguments after the defaults.
std::vector<std::string> words_of(int argc, char** argv) {
  std::vector<std::string> words{argv[0]};
  words.insert(words.end(), kDefaults.begin(), kDefaults.end());
  words.insert(words.end(), argv + 1, argv + argc);
  return words;
}

int run(std::vector<std::string> words) {
  std::vector<char*> arguments(words.size() + 1, nullptr);
  std::ranges::transform(words, arguments.begin(), [](std::string& word) { return word.data(); });
  auto count = static_cast<int>(words.size());
  slipstick::bench::Suite suite;
  slipstick::bench::add_influence_benchmarks(suite);
  slipstick::bench::add_operator_benchmarks(suite);
  slipstick::bench::add_solve_benchmarks(suite);
  slipstick::bench::add_exact_benchmarks(suite);
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  say_where_times_come_from();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

}  // namespace

int main(int argc, char** argv) try { return run(words_of(argc, argv)); } catch (const std::exception& exception) {
  std::fprintf(stderr, "slipstick_benchmarks: %s\n", exception.what());
  return 2;
}
