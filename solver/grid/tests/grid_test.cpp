#include "solver/grid/grid.hpp"

#include <gtest/gtest.h>

namespace slipstick::solver {
namespace {

TEST(FastLength, IsTheSmallestEvenProductOfSmallPrimes) {
  const auto is_fast = [](Index length) {
    for (const Index factor : {2, 3, 5, 7}) {
      while (length % factor == 0) length /= factor;
    }
    return length == 1;
  };
  for (Index minimum = 1; minimum <= 2100; ++minimum) {
    Index expected = 4;
    while (expected < minimum || expected % 2 != 0 || !is_fast(expected)) ++expected;
    ASSERT_EQ(fast_length(minimum), expected) << minimum;
  }
  EXPECT_EQ(fast_length(1), 4);
  EXPECT_EQ(fast_length(11), 12);
  EXPECT_EQ(fast_length(127), 128);
  EXPECT_EQ(fast_length(2047), 2048);
}

}  // namespace
}  // namespace slipstick::solver
