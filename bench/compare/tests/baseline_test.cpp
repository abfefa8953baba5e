#include "bench/compare/baseline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "bench/timing/timings.hpp"
#include "convergence/programs/temporary_folder.hpp"

namespace slipstick::bench {
namespace {

using Json = nlohmann::ordered_json;

Json row(const std::string& name, int repetition, double milliseconds) {
  return {{"name", name + "/repeats:3"},
          {"run_name", name},
          {"run_type", "iteration"},
          {"repetitions", 3},
          {"repetition_index", repetition},
          {"threads", 1},
          {"iterations", 100},
          {"real_time", milliseconds},
          {"cpu_time", milliseconds},
          {"time_unit", "ms"},
          {"error", 1e-13}};
}

Json made_timings(double milliseconds) {
  Json timings{{"context",
                {{"date", "2026-01-01"},
                 {"host_name", "private"},
                 {"num_cpus", 2},
                 {"machine", "m"},
                 {"executable", "/home/someone/program"}}},
               {"benchmarks", Json::array()}};
  for (int i = 0; i < 3; ++i)
    timings["benchmarks"].push_back(row("apply/cells:64", i, milliseconds * (i + 1)));
  return timings;
}

BaselineOrigin origin(const std::string& reason) {
  return {.date = "2026-01-01", .version = "1.0", .commit = "abc", .reason = reason};
}

TEST(Baseline, KeepsTimesAndSaysWhereTheyCameFrom) {
  const Json baseline = make_baseline(made_timings(1.23456), nullptr, origin("the first one"));
  ASSERT_EQ(baseline["benchmarks"].size(), 3U);
  EXPECT_EQ(baseline["benchmarks"][0]["real_time"], 1.235);
  EXPECT_EQ(baseline["history"][0]["reason"], "the first one");
  EXPECT_DOUBLE_EQ(baseline["history"][0]["seconds"]["apply/cells:64"].get<double>(),
                   2.469e-3);  // the median
}

TEST(Baseline, NamesNeitherHostNorFolders) {
  const std::string text = make_baseline(made_timings(1.0), nullptr, origin("first")).dump();
  EXPECT_EQ(text.find("private"), std::string::npos);
  EXPECT_EQ(text.find("/home"), std::string::npos);
}

TEST(Baseline, RemembersTheOnesBefore) {
  const Json first = make_baseline(made_timings(1.0), nullptr, origin("first"));
  const Json second = make_baseline(made_timings(2.0), first, origin("new transforms"));
  ASSERT_EQ(second["history"].size(), 2U);
  EXPECT_EQ(second["history"][0], first["history"][0]);
  EXPECT_EQ(second["history"][1]["reason"], "new transforms");
}

TEST(Baseline, LeavesOutWhatWasNotTimed) {
  Json timings = made_timings(1.0);
  timings["benchmarks"][1]["error_occurred"] = true;
  timings["benchmarks"][2]["run_type"] = "aggregate";
  EXPECT_EQ(make_baseline(timings, nullptr, origin("first"))["benchmarks"].size(), 1U);
}

TEST(Baseline, IsAFileOfTimings) {
  const convergence::TemporaryFolder folder;
  const auto file = baseline_file(folder / "", "m");
  const Json baseline = make_baseline(made_timings(1.0), nullptr, origin("first"));
  write_baseline(file, baseline);
  std::ifstream stream(file);
  EXPECT_EQ(Json::parse(stream), baseline);
  const Timings read = read_timings(file);
  ASSERT_EQ(read.benchmarks.size(), 1U);
  EXPECT_EQ(read.context.machine, "m");
  ASSERT_EQ(read.benchmarks[0].timings.size(), 3U);
  EXPECT_DOUBLE_EQ(read.benchmarks[0].timings[2].real, 3e-3);
}

}  // namespace
}  // namespace slipstick::bench
