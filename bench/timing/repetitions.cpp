#include "bench/timing/repetitions.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <stdexcept>

#include "bench/timing/median.hpp"

namespace slipstick::bench {
namespace {

/// Work is repeated at least this often, then until the second number or until so many seconds have passed.
constexpr int kMinRepetitions = 3;
constexpr int kMaxRepetitions = 9;
constexpr double kEnoughSeconds = 1.0;
/// Chance that the median lies below a 95 % interval.
constexpr double kTail = 0.025;

}  // namespace

Repetitions summarise(std::vector<double> seconds) {
  if (seconds.empty()) throw std::invalid_argument("no repetition");
  std::sort(seconds.begin(), seconds.end());
  const std::size_t n = seconds.size();
  std::size_t left_out = 0;  // on each side: from the k-th smallest to the k-th largest, k - 1 of them
  while (gsl_cdf_binomial_P(static_cast<unsigned>(left_out + 1), 0.5, static_cast<unsigned>(n)) <= kTail) {
    ++left_out;
  }
  return {median(seconds), seconds[left_out], seconds[n - 1 - left_out], static_cast<int>(n)};
}

Repetitions repeat(const std::function<double()>& work) {
  std::vector<double> seconds;
  double total = 0.0;
  while (static_cast<int>(seconds.size()) < kMinRepetitions ||
         (static_cast<int>(seconds.size()) < kMaxRepetitions && total < kEnoughSeconds)) {
    seconds.push_back(work());
    total += seconds.back();
  }
  return summarise(seconds);
}

}  // namespace slipstick::bench
