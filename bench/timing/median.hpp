#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace slipstick::bench {

/// Of an even number of values the mean of the two in the middle. There must be one at least.
inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

}  // namespace slipstick::bench
