#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace slipstick::bench {

/// The median of sorted values, one at least; that of an even number is the mean of the two in the middle.
inline double median_of_sorted(const std::vector<double>& sorted) {
  return 0.5 * (sorted[(sorted.size() - 1) / 2] + sorted[sorted.size() / 2]);
}
inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return median_of_sorted(values);
}

}  // namespace slipstick::bench
