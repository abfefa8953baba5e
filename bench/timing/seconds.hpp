#pragma once

#include <chrono>

namespace slipstick::bench {

/// Seconds that work takes, by the clock.
template <typename Work>
double seconds(Work&& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace slipstick::bench
