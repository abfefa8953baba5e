#pragma once

#include <chrono>
#include <functional>
#include <vector>

namespace slipstick::bench {

/// Median of repeated times, with its 95 % interval where there are six or more (order statistics); of fewer
/// the quickest and the slowest.
struct Repetitions {
  double median = 0.0;
  double low = 0.0;
  double high = 0.0;
  int number = 0;
};

/// Seconds that work takes, by the clock.
template <typename Work>
double seconds(Work&& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Throws std::invalid_argument for no seconds at all.
Repetitions summarise(std::vector<double> seconds);

/// Repeats work that returns its own seconds: often where it is quick, three times where it takes seconds.
Repetitions repeat(const std::function<double()>& work);

}  // namespace slipstick::bench
