#include "solver/grid/grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "solver/solve.hpp"
#include "solver/tests/paper_scene.hpp"

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

/// Spheres on grids of any place and size: Hertz's radius and the exact stick radius (theory.md) are known.
TEST(CountedArea, CoversExactAreasOfSpheres) {
  constexpr double kStickRatio = 0.8135681261276495;  // at half of the limit moment: Eq. (4), Lubkin 1951
  std::mt19937_64 random(20261125);
  std::uniform_real_distribution<double> across(14.0, 60.0);
  int close = 0;
  double counted = 0.0;
  double corrected = 0.0;
  constexpr int kDraws = 40;
  for (int k = 0; k < kDraws; ++k) {
    Scene scene = paper_scene(64, 0.5);
    const double size = 64.0 * 2.0 * paper::kContactRadius / across(random);
    scene.grid.extent = {size, size};
    const Solution solution = solve(scene);
    for (const auto& [area, ratio] :
         {std::pair{solution.contact_area, 1.0}, std::pair{solution.stick_area, kStickRatio}}) {
      const double exact = std::numbers::pi * std::pow(ratio * paper::kContactRadius, 2);
      close += static_cast<int>(std::abs(area.corrected - exact) <= area.uncertainty);
      counted += (area.counted - exact) / area.counted;
      corrected += (area.corrected - exact) / area.counted;
    }
  }
  EXPECT_GE(close, 0.985 * 2 * kDraws);
  EXPECT_LT(std::abs(corrected), 0.3 * counted);
}

}  // namespace
}  // namespace slipstick::solver
