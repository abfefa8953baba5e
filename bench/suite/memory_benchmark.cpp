// What this machine's memory gives one thread: reading, and McCalpin's triad (STREAM, 1995).

#include <memory>
#include <vector>

#include "bench/suite/suite.hpp"
#include "bench/timing/bandwidth.hpp"

namespace slipstick::bench {
namespace {

/// Of each array: 256 MiB, of which no cache holds more than a part.
constexpr std::size_t kCount = std::size_t{1} << 25;

benchmark::Counter bytes_per_second(std::size_t values) {
  return rate(static_cast<double>(values * sizeof(double)));
}

Prepared reading() {
  const auto array = std::make_shared<std::vector<double>>(kCount, 1.0);
  return {
      .counters = {{"bytes_per_second", bytes_per_second(kCount)}},
      .invalid_reason = sum(*array) == static_cast<double>(kCount) ? "" : "the sum of so many ones is wrong",
      .timing = repeated([array] { benchmark::DoNotOptimize(sum(*array)); })};
}

/// Bytes by STREAM's count: two arrays read, one written; that it is read before it is written is left out.
Prepared triad() {
  const auto a = std::make_shared<std::vector<double>>(kCount, 0.0);
  const auto b = std::make_shared<std::vector<double>>(kCount, 1.0);
  const auto c = std::make_shared<std::vector<double>>(kCount, 2.0);
  const auto work = [a, b, c] {
    for (std::size_t i = 0; i < kCount; ++i) (*a)[i] = (*b)[i] + 3.0 * (*c)[i];
    benchmark::DoNotOptimize(a->data());
    benchmark::ClobberMemory();
  };
  work();
  return {.counters = {{"bytes_per_second", bytes_per_second(3 * kCount)}},
          .invalid_reason = sum(*a) == 7.0 * static_cast<double>(kCount) ? "" : "the triad is wrong",
          .timing = repeated(work)};
}

}  // namespace

void add_memory_benchmarks(Suite& suite) {
  suite.add("memory/read", reading);
  suite.add("memory/triad", triad);
}

}  // namespace slipstick::bench
