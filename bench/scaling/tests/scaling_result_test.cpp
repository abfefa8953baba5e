#include "bench/scaling/scaling_result.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace slipstick::bench {
namespace {

using nlohmann::ordered_json;
using testing::ElementsAre;

TimedBenchmark timed(const std::string& name, double seconds) {
  return {.name = name,
          .timings = {{seconds, seconds}, {1.01 * seconds, seconds}, {0.99 * seconds, seconds}},
          .counters = {{"error", 1e-15}},
          .error = "",
          .skipped = ""};
}

/// dense 1e-9 N^4, dcfft 64 times 1e-9 N^2: they meet at 8 cells.
Timings made() {
  Timings timings;
  for (const int cells : {4, 6, 12, 24, 48}) {
    const std::string size = "/cells:" + std::to_string(cells);
    timings.benchmarks.push_back(timed("application/dense" + size, 1e-9 * std::pow(cells, 4)));
    timings.benchmarks.push_back(timed("application/dcfft" + size, 64e-9 * cells * cells));
  }
  return timings;
}

std::vector<std::string> names(const ordered_json& result) {
  std::vector<std::string> all;
  for (const auto& family : result["families"]) all.push_back(family["name"]);
  return all;
}

TEST(ScalingResult, HasTheFamiliesInTheirOrderBySize) {
  const ordered_json result = scaling_json(made());
  EXPECT_THAT(names(result), ElementsAre("application/dense", "application/dcfft"));
  const ordered_json& rows = result["families"][0]["rows"];
  ASSERT_EQ(rows.size(), 5U);
  EXPECT_EQ(rows[2]["cells"], 12);
  EXPECT_NEAR(rows[2]["seconds"], 1e-9 * std::pow(12.0, 4), 1e-16);
  EXPECT_LT(rows[2]["low"], rows[2]["seconds"]);
  EXPECT_GT(rows[2]["high"], rows[2]["seconds"]);
  EXPECT_EQ(rows[2]["repetitions"], 3);
  EXPECT_EQ(rows[2]["error"], 1e-15);
}

TEST(ScalingResult, SaysWhatTheoryAndTimesSay) {
  const ordered_json result = scaling_json(made());
  EXPECT_NEAR(result["families"][0]["power_law"]["exponent"], 4.0, 1e-12);
  EXPECT_EQ(result["families"][0]["power_law"]["theory"], "N^4");
  EXPECT_EQ(result["families"][1]["power_law"]["theory"], "N^2 log N");
  EXPECT_NEAR(result["families"][0]["power_law"]["expected"], 4.0, 1e-12);
  // N^2 log 2N from 6 to 48 cells.
  EXPECT_NEAR(result["families"][1]["power_law"]["expected"],
              2.0 + std::log2(std::log(96.0) / std::log(12.0)) / 3.0, 1e-12);
}

TEST(ScalingResult, SaysWhereDcfftOvertakes) {
  const ordered_json result = scaling_json(made());
  ASSERT_EQ(result["crossovers"].size(), 1U);
  const ordered_json& crossover = result["crossovers"][0];
  EXPECT_EQ(crossover["slow"], "application/dense");
  EXPECT_EQ(crossover["quick"], "application/dcfft");
  EXPECT_NEAR(crossover["cells"], 8.0, 1e-9);
  EXPECT_LT(crossover["low"], 8.0);
  EXPECT_GT(crossover["high"], 8.0);
}

TEST(ScalingResult, TakesTheCellsOutOfAnyPlaceOfAName) {
  Timings timings;
  for (const char* name : {"cells:8", "solve/coulomb/cells:64/permille:900", "a/b", "a/cells:/b", "a/cells:x",
                           "a/notcells:8", "solve/coulomb/cells:8/permille:900"}) {
    timings.benchmarks.push_back(timed(name, 1.0));
  }
  const ordered_json result = scaling_json(timings);
  EXPECT_THAT(names(result), ElementsAre("", "solve/coulomb/permille:900"));
  EXPECT_EQ(result["families"][1]["rows"][0]["cells"], 8);
  EXPECT_EQ(result["families"][1]["rows"][1]["cells"], 64);
}

TEST(ScalingResult, OfWhatWasNotTimedSaysWhy) {
  Timings timings = made();
  timings.benchmarks[2].error = "disagrees with its reference";
  timings.benchmarks[0].timings = {{std::numeric_limits<double>::quiet_NaN(), 0.0}};
  timings.benchmarks[0].counters.clear();
  const ordered_json result = scaling_json(timings);
  const ordered_json& rows = result["families"][0]["rows"];
  EXPECT_TRUE(rows[1]["seconds"].is_null());
  EXPECT_NE(rows[1].dump().find("disagrees with its reference"), std::string::npos);
  EXPECT_TRUE(rows[0]["seconds"].is_null());
  EXPECT_TRUE(rows[0]["error"].is_null());
  EXPECT_NEAR(result["families"][0]["power_law"]["exponent"], 4.0, 1e-12);
}

TEST(ScalingResult, OfOneSizeFitsNothing) {
  Timings timings;
  timings.benchmarks.push_back(timed("set_up/dcfft/cells:64", 1.0));
  const ordered_json family = scaling_json(timings)["families"][0];
  EXPECT_TRUE(family["power_law"]["exponent"].is_null());
  EXPECT_TRUE(family["power_law"]["theory"].is_null());
  EXPECT_TRUE(scaling_json({})["families"].empty());
}

}  // namespace
}  // namespace slipstick::bench
