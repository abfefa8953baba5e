#include "convergence/extrapolation.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace slipstick::convergence {
namespace {

/// Values that tend to 2 with a known order.
std::array<double, 3> sequence(double order, const std::array<double, 3>& sizes) {
  std::array<double, 3> values{};
  for (std::size_t i = 0; i < 3; ++i) values[i] = 2.0 - 0.3 * std::pow(sizes[i], order);
  return values;
}

void expect_found(double order, const std::array<double, 3>& sizes) {
  const auto values = sequence(order, sizes);
  const Extrapolation found = extrapolate(values, sizes);
  ASSERT_TRUE(found.order) << order;
  constexpr double rounding = 1e-12;  // of differences of numbers near 2, over the least change, above 1e-3
  EXPECT_NEAR(*found.order, order, rounding);
  EXPECT_NEAR(found.limit, 2.0, rounding);
  EXPECT_NEAR(found.uncertainty, 2.0 - values[2], rounding);
}

TEST(Extrapolation, FindsLimitAndOrderOfAPower) {
  for (const double order : {0.6, 1.0, 1.5, 2.0, 2.9}) {
    expect_found(order, {1.0, 0.5, 0.25});
    expect_found(order, {1.0, 0.48, 0.2365});  // grids with the same margin of cells are not exact halves
  }
}

/// Only ratios of sizes matter, and a sequence upside down has its limit upside down.
TEST(Extrapolation, KnowsNoUnits) {
  const auto values = sequence(1.5, {1.0, 0.5, 0.25});
  const Extrapolation small =
      extrapolate({-1e-6 * values[0], -1e-6 * values[1], -1e-6 * values[2]}, {4e-9, 2e-9, 1e-9});
  EXPECT_NEAR(small.limit, -2e-6, 1e-18);
  EXPECT_GT(small.uncertainty, 0.0);
}

void expect_not_fitted(const std::array<double, 3>& values, double uncertainty) {
  const Extrapolation found = extrapolate(values, {1.0, 0.5, 0.25});
  EXPECT_FALSE(found.order);
  EXPECT_EQ(found.limit, values[2]);
  EXPECT_EQ(found.uncertainty, uncertainty);
}

TEST(Extrapolation, LeavesWhatFollowsNoPowerAlone) {
  expect_not_fitted({1.0, 2.0, 1.75}, 0.25);      // turns back
  expect_not_fitted({1.0, 2.0, 3.0}, 1.0);        // does not settle
  expect_not_fitted({1.0, 2.0, 2.75}, 0.75);      // order 0.4
  expect_not_fitted({1.0, 2.0, 2.0625}, 0.0625);  // order 4
  expect_not_fitted({2.0, 2.0, 2.0}, 0.0);
  expect_not_fitted({1.0, 2.0, 2.0}, 0.0);
}

TEST(Extrapolation, PassesNaNOn) {
  EXPECT_TRUE(std::isnan(extrapolate({1.0, 2.0, NAN}, {1.0, 0.5, 0.25}).limit));
  const Extrapolation broken = extrapolate({NAN, 2.0, 2.5}, {1.0, 0.5, 0.25});
  EXPECT_FALSE(broken.order);
  EXPECT_EQ(broken.limit, 2.5);
}

}  // namespace
}  // namespace slipstick::convergence
