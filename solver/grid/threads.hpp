#pragma once

#include <thread>
#include <vector>

#include "solver/grid/grid.hpp"

namespace slipstick::solver {

/// Cuts [0, count) into as many contiguous parts as there are threads and calls work(thread, first, last) on
/// each at the same time, the last part on the calling thread. The parts do not depend on timing, so results
/// do not either. With one thread it allocates nothing. The work must not throw.
template <typename Work>
void in_parts(int threads, Index count, const Work& work) {
  const auto bound = [&](int part) { return count * part / threads; };
  std::vector<std::jthread> others;
  for (int thread = 0; thread + 1 < threads; ++thread) {
    others.emplace_back(
        [&work, thread, first = bound(thread), last = bound(thread + 1)] { work(thread, first, last); });
  }
  work(threads - 1, bound(threads - 1), count);
}

}  // namespace slipstick::solver
