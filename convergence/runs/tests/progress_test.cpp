#include "convergence/runs/progress.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace slipstick::convergence {
namespace {

using Seconds = std::chrono::seconds;

TEST(Progress, EstimatesByTheWorkThatIsDone) {
  const auto start = Progress::Clock::now();
  Progress progress;
  progress.begin_runs(3, 8.0, 3, start);
  EXPECT_TRUE(std::isnan(progress.seconds_left(start)));
  progress.finished("a", 2.0, start + Seconds(5));
  EXPECT_NEAR(progress.seconds_left(start + Seconds(5)), 15.0, 1e-9);
  EXPECT_EQ(progress.text(), "1 of 3");
  progress.finished("b", 6.0 + 1e-12, start + Seconds(9));  // rounding leaves less than nothing
  EXPECT_EQ(duration_text(progress.seconds_left(start + Seconds(9))), "");
}

/// Shares 1, 3, 6: the first stage takes 10 s, so that all others take 90 s.
TEST(Progress, EstimatesAllStages) {
  const auto start = Progress::Clock::now();
  Progress progress({{"one", 1.0}, {"two", 3.0}, {"three", 6.0}});
  progress.begin("one", start);
  progress.begin_runs(2, 2.0, 2, start);
  progress.finished("a", 1.0, start + Seconds(5));
  EXPECT_NEAR(progress.seconds_left(start + Seconds(5)), 5.0 + 90.0, 1e-9);
  progress.finished("b", 1.0, start + Seconds(10));
  progress.begin("unplanned", start + Seconds(10));
  progress.begin("two", start + Seconds(10));
  EXPECT_NEAR(progress.seconds_left(start + Seconds(10)), 90.0, 1e-9);
  EXPECT_NEAR(progress.seconds_left(start + Seconds(20)), 80.0, 1e-9);
  progress.begin("three", start + Seconds(40));
  EXPECT_NEAR(progress.seconds_left(start + Seconds(500)), 0.0, 1e-9);
}

/// Results that were kept say nothing about the time of the later stages.
TEST(Progress, AStageThatWasKeptIsNoMeasure) {
  const auto start = Progress::Clock::now();
  Progress progress({{"one", 1.0}, {"two", 1.0}, {"three", 1.0}});
  progress.begin("one", start);
  progress.begin_runs(0, 0.0, 7, start);
  progress.begin("two", start + Seconds(1));
  EXPECT_TRUE(std::isnan(progress.seconds_left(start + Seconds(1))));
  progress.begin_runs(1, 1.0, 4, start + Seconds(1));  // a quarter of the stage
  progress.finished("a", 1.0, start + Seconds(6));
  progress.begin("three", start + Seconds(6));
  EXPECT_NEAR(progress.seconds_left(start + Seconds(6)), 20.0, 1e-9);
}

TEST(Progress, TimesAreShortAndNeverBelowZero) {
  EXPECT_EQ(duration_text(-0.0) + duration_text(-3.0) + duration_text(0.4) + duration_text(std::nan("")), "");
  EXPECT_EQ(duration_text(40.4), "40 s");
  EXPECT_EQ(duration_text(180.0), "3 min");
}

}  // namespace
}  // namespace slipstick::convergence
