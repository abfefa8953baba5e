#pragma once

#include <chrono>
#include <cstddef>
#include <ctime>
#include <vector>

#include "bench/timing/median.hpp"

/// Times that can be compared on a machine that does other things as well.
namespace slipstick::bench {

/// Seconds that work takes.
template <typename Work>
double seconds(Work&& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// First over second: by the clock, and by what the processor spent on them, which knows nothing of the time
/// that other programs took.
struct SideBySide {
  double ratio;
  double cpu_ratio;
};

/// Rounds go on for `seconds` and at least `rounds` times, unless they take `most_seconds`.
struct Patience {
  double seconds = 1.0;
  std::size_t rounds = 5;
  double most_seconds = 6.0;
};

struct Lap {
  double seconds;  ///< that count
  double cpu;
};

/// Means over calls that fill `wanted` seconds, one call at least.
template <typename Timed>
Lap call_for(double wanted, Timed& timed) {
  double total = 0.0;
  double calls = 0.0;
  const std::clock_t start = std::clock();
  do {
    total += timed();
    ++calls;
  } while (total < wanted);
  const auto cpu = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return {total / calls, cpu / calls};
}

/// The two in turn, so that what else the machine does falls on both; the quicker one several times a round,
/// so that it does not sample too short a part of it. Each returns the seconds that count. Medians of all
/// rounds.
template <typename First, typename Second>
SideBySide side_by_side(First&& first, Second&& second, const Patience& patience = {}) {
  constexpr double kShare = 0.5;  // of the slower one's time that the quicker one gets at least
  std::vector<double> ratios, cpu_ratios;
  Lap other{};
  const auto start = std::chrono::steady_clock::now();
  for (double total = 0.0;
       total < patience.seconds || (ratios.size() < patience.rounds && total < patience.most_seconds);) {
    const Lap one = call_for(kShare * other.seconds, first);
    other = call_for(kShare * one.seconds, second);
    ratios.push_back(one.seconds / other.seconds);
    cpu_ratios.push_back(one.cpu / other.cpu);
    total = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return {median(ratios), median(cpu_ratios)};
}

}  // namespace slipstick::bench
