#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "convergence/hard/rounding_digits.hpp"

namespace slipstick::convergence {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Deviations of 2e-8 to either side: a standard deviation of 1e-8 of the value.
TEST(SurvivingDigits, AreThoseBelowTheDeviation) {
  const std::vector<double> samples{2.0 + 2e-8, 2.0 - 2e-8, 2.0 + 2e-8, 2.0 - 2e-8};
  EXPECT_NEAR(surviving_digits(2.0, samples).value, 8.0, 1e-7);
  EXPECT_NEAR(surviving_digits(-2.0, {-2.0 - 2e-8}).value, 8.0, 1e-7);
  // Quantiles of chi-square with 4 degrees of freedom: 0.48442, 11.14329.
  EXPECT_NEAR(surviving_digits(2.0, samples).low, 8.0 - 0.5 * std::log10(4.0 / 0.48442), 1e-5);
  EXPECT_NEAR(surviving_digits(2.0, samples).high, 8.0 + 0.5 * std::log10(11.14329 / 4.0), 1e-5);
}

TEST(SurvivingDigits, AreFromNoneToAll) {
  EXPECT_EQ(surviving_digits(2.0, {2.0, 2.0}).low, kAllDigits);
  EXPECT_EQ(surviving_digits(0.0, {0.0}).value, kAllDigits);
  EXPECT_EQ(surviving_digits(0.0, {1e-20, -1e-20}).value, 0.0);
  EXPECT_EQ(surviving_digits(1.0, {100.0}).value, 0.0);
  EXPECT_TRUE(std::isnan(surviving_digits(1.0, {1.0, kNan}).value));
  EXPECT_TRUE(std::isnan(surviving_digits(kNan, {1.0}).low));
  EXPECT_THROW(surviving_digits(1.0, {}), std::invalid_argument);
}

// In about 95 % of 400 made experiments with a known deviation the interval holds the truth.
TEST(SurvivingDigits, IntervalHoldsTheTruthAsOftenAsItSays) {
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal(0.0, 1e-6);
  int held = 0;
  for (int experiment = 0; experiment < 400; ++experiment) {
    std::vector<double> samples(10);
    for (double& sample : samples) sample = 1.0 + normal(generator);
    const Digits found = surviving_digits(1.0, samples);
    held += found.low <= 6.0 && 6.0 <= found.high ? 1 : 0;
  }
  EXPECT_GT(held, 360);  // 380 expected; four standard deviations are 18
  EXPECT_LT(held, 398);
}

}  // namespace
}  // namespace slipstick::convergence
