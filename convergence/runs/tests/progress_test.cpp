#include "convergence/runs/progress.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace slipstick::convergence {
namespace {

using Seconds = std::chrono::seconds;

TEST(Progress, EstimatesByTheWorkThatIsDone) {
  const auto start = Progress::Clock::now();
  Progress progress;
  progress.begin_runs(2, 8.0, 2, start);
  EXPECT_TRUE(std::isnan(progress.seconds_left(start)));
  progress.finished("a", 2.0, start + Seconds(5));
  EXPECT_NEAR(progress.seconds_left(start + Seconds(5)), 15.0, 1e-9);
  progress.finished("b", 6.0 + 1e-12, start + Seconds(9));  // rounding leaves less than nothing
  EXPECT_EQ(duration_text(progress.seconds_left(start + Seconds(9))) + duration_text(-0.0), "");
  EXPECT_EQ(duration_text(40.4) + duration_text(180.0), "40 s3 min");
}

/// Shares 1, 1, 3, 6: a stage whose results were kept is no measure; the second stage takes 10 s.
TEST(Progress, EstimatesAllStages) {
  const auto start = Progress::Clock::now();
  Progress progress({{"kept", 1.0}, {"one", 1.0}, {"two", 3.0}, {"three", 6.0}});
  progress.begin("kept", start);
  progress.begin_runs(0, 0.0, 7, start);
  progress.begin("one", start + Seconds(1));
  EXPECT_TRUE(std::isnan(progress.seconds_left(start + Seconds(1))));
  progress.begin_runs(2, 2.0, 2, start + Seconds(1));
  progress.finished("a", 1.0, start + Seconds(6));
  EXPECT_NEAR(progress.seconds_left(start + Seconds(6)), 5.0 + 90.0, 1e-9);
  progress.begin("unplanned", start + Seconds(11));
  progress.begin("two", start + Seconds(11));
  EXPECT_NEAR(progress.seconds_left(start + Seconds(21)), 80.0, 1e-9);
  progress.begin("three", start + Seconds(41));
  EXPECT_NEAR(progress.seconds_left(start + Seconds(500)), 0.0, 1e-9);
}

}  // namespace
}  // namespace slipstick::convergence
