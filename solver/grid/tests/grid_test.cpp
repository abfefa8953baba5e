#include "solver/grid/grid.hpp"

#include <gtest/gtest.h>

namespace slipstick::solver {
namespace {

TEST(FastLength, IsAPowerOfTwoNearbyOrTheSmallestEvenProductOfSmallPrimes) {
  const auto is_fast = [](Index length) {
    for (const Index factor : {2, 3, 5, 7}) {
      while (length % factor == 0) length /= factor;
    }
    return length == 1;
  };
  for (Index minimum = 1; minimum <= 2100; ++minimum) {
    Index power = 4;
    while (power < minimum) power *= 2;
    if (power - minimum <= minimum / 16) {
      ASSERT_EQ(fast_length(minimum), power) << minimum;
      continue;
    }
    Index expected = 4;
    while (expected < minimum || expected % 2 != 0 || !is_fast(expected)) ++expected;
    ASSERT_EQ(fast_length(minimum), expected) << minimum;
  }
}

TEST(Zeros, GivesBackNoPagesOfOtherFields) {
  for (const Index values : {0, 1, 700, 1500, 1 << 20}) {
    const Eigen::ArrayXd before = Eigen::ArrayXd::Ones(values), field = zeros(values), after = before;
    EXPECT_TRUE((before == 1.0).all() && (field == 0.0).all() && (after == 1.0).all()) << values;
  }
}

TEST(CountedArea, AnEdgeHasTheSidesThatItHas) {
  const Grid grid{6, 5, 0.5, 0.25};
  Eigen::ArrayXd inside = Eigen::ArrayXd::Zero(grid.cells());
  EXPECT_EQ(counted_area(grid, inside).corrected, 0.0);
  EXPECT_EQ(counted_area(grid, inside).uncertainty, 0.0);
  inside[2 * 5 + 2] = 1.0;
  const CountedArea one = counted_area(grid, inside);
  inside.setOnes();  // up to the grid's edge
  const CountedArea all = counted_area(grid, inside);
  EXPECT_DOUBLE_EQ(one.counted, 0.125);
  EXPECT_DOUBLE_EQ(all.counted, 30 * 0.125);
  EXPECT_NEAR((all.counted - all.corrected) / (one.counted - one.corrected), 22.0 / 4.0, 1e-12);
  EXPECT_EQ(counted_area(grid, inside, 0.0).corrected, all.counted);
}

}  // namespace
}  // namespace slipstick::solver
