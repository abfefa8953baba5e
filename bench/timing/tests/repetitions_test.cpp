#include "bench/timing/repetitions.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace {

using slipstick::bench::repeat;
using slipstick::bench::Repetitions;
using slipstick::bench::summarise;

TEST(Repetitions, OfFewGoFromTheQuickestToTheSlowest) {
  const Repetitions times = summarise({3.0, 1.0, 2.0});
  EXPECT_EQ(times.median, 2.0);
  EXPECT_EQ(times.low, 1.0);
  EXPECT_EQ(times.high, 3.0);
  EXPECT_EQ(times.number, 3);
  EXPECT_EQ(summarise({1.0, 2.0}).median, 1.5);
  EXPECT_THROW(summarise({}), std::invalid_argument);
}

/// Tables of order statistics (David and Nagaraja 2003): of 8 the whole range (99.2 %), of 9 from the second
/// to the eighth (96.1 %), of 12 from the third to the tenth (96.1 %).
TEST(Repetitions, HaveTheIntervalOfOrderStatistics) {
  const auto interval = [](int n) {
    std::vector<double> values;
    for (int i = 1; i <= n; ++i) values.push_back(i);
    const Repetitions times = summarise(values);
    return std::pair(times.low, times.high);
  };
  EXPECT_EQ(interval(8), std::pair(1.0, 8.0));
  EXPECT_EQ(interval(9), std::pair(2.0, 8.0));
  EXPECT_EQ(interval(12), std::pair(3.0, 10.0));
}

TEST(Repetitions, AreManyOfQuickWorkAndThreeOfSlow) {
  EXPECT_EQ(repeat([] { return 1e-3; }).number, 9);
  EXPECT_EQ(repeat([] { return 10.0; }).number, 3);
}

}  // namespace
