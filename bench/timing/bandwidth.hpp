#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>

#include "bench/timing/side_by_side.hpp"

/// How quickly memory can be read.
namespace slipstick::bench {

/// The sum of an array, read from several places at a time, as one stream alone does not keep memory busy, in
/// many partial sums, so that additions do not wait for each other.
inline double sum(std::span<const double> values) {
  constexpr std::size_t kStreams = 8;
  constexpr std::size_t kAtATime = 8;
  const std::size_t length = values.size() / (kStreams * kAtATime) * kAtATime;
  std::array<double, kStreams * kAtATime> sums{};
  for (std::size_t i = 0; i < length; i += kAtATime) {
    for (std::size_t stream = 0; stream < kStreams; ++stream) {
      for (std::size_t k = 0; k < kAtATime; ++k) {
        sums[stream * kAtATime + k] += values[stream * length + i + k];
      }
    }
  }
  const auto rest = values.subspan(kStreams * length);
  return std::accumulate(sums.begin(), sums.end(), 0.0) + std::accumulate(rest.begin(), rest.end(), 0.0);
}

/// Seconds to read an array once, from whichever cache or memory holds it by then: the least of several
/// passes. What reads it once in a computation cannot take less.
inline double seconds_to_read(std::span<const double> values) {
  constexpr std::size_t kMinPasses = 5;
  constexpr double kLongEnough = 0.02;
  double least = std::numeric_limits<double>::infinity();
  double total = 0.0;
  for (std::size_t pass = 0; pass < kMinPasses || total < kLongEnough; ++pass) {
    const double taken = seconds([&] { benchmark::DoNotOptimize(sum(values)); });
    least = std::min(least, taken);
    total += taken;
  }
  return least;
}

}  // namespace slipstick::bench
