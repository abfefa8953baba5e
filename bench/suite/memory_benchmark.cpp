// The bandwidth that this machine's memory gives one thread, by McCalpin's triad (STREAM, 1995).

#include <memory>
#include <numeric>
#include <vector>

#include "bench/suite/suite.hpp"

namespace slipstick::bench {
namespace {

/// Values of each array: 256 MiB, more than any cache holds.
constexpr std::size_t kValues = std::size_t{1} << 25;

/// STREAM counts two arrays that are read and one that is written, and leaves out the reading before a write.
Prepared triad() {
  const auto a = std::make_shared<std::vector<double>>(kValues, 0.0);
  const auto b = std::make_shared<std::vector<double>>(kValues, 1.0);
  const auto c = std::make_shared<std::vector<double>>(kValues, 2.0);
  const auto work = [a, b, c] {
    for (std::size_t i = 0; i < kValues; ++i) (*a)[i] = (*b)[i] + 3.0 * (*c)[i];
    benchmark::DoNotOptimize(a->data());
    benchmark::ClobberMemory();
  };
  work();
  const double sum = std::accumulate(a->begin(), a->end(), 0.0);
  return {.counters = {{"bytes_per_second", rate(static_cast<double>(3 * kValues * sizeof(double)))}},
          .invalid_reason = sum == 7.0 * static_cast<double>(kValues) ? "" : "the triad is wrong",
          .timing = repeated(work)};
}

}  // namespace

void add_memory_benchmarks(Suite& suite) { suite.add("memory/triad", triad); }

}  // namespace slipstick::bench
