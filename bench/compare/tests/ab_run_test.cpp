#include "bench/compare/ab_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "bench/compare/tests/made_program.hpp"
#include "convergence/programs/temporary_folder.hpp"

namespace slipstick::bench {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using testing::lines_of;
using testing::made_program;

class ABRun : public ::testing::Test {
 protected:
  fs::path made(const std::string& label, const std::string& list = "f\\n", double milliseconds = 1.0) {
    return made_program(folder_ / "", label, list, milliseconds);
  }
  std::vector<std::string> log() const { return lines_of(folder_ / "log"); }

 private:
  convergence::TemporaryFolder folder_;
};

TEST_F(ABRun, HasTheBenchmarksOfEitherBuild) {
  std::vector<std::string> found;
  for (const auto& pair : two_builds(made("base", "common\\nold\\n"), made("now", "new\\ncommon\\n"), "")) {
    found.push_back(pair.name + ": " + pair.sides[0].benchmark + "|" + pair.sides[1].benchmark);
  }
  EXPECT_THAT(found, ElementsAre("common: common|common", "old: old|", "new: |new"));
}

TEST_F(ABRun, ReportsABenchmarkThatIsInOneBuildOnly) {
  const auto pairs = two_builds(made("base", "common\\nold\\n"), made("now", "common\\nnew\\n", 1.01), "");
  const Comparison comparison = run_ab(pairs, 10).report.comparison;
  EXPECT_THAT(comparison.obstacles, ::testing::IsEmpty());
  std::vector<std::string> findings;
  for (const auto& found : comparison.benchmarks) {
    findings.push_back(found.name + ": " + to_string(found.finding));
  }
  EXPECT_THAT(findings, ElementsAre("common: same", "old: only in base", "new: only in new"));
  EXPECT_EQ(exit_code(comparison), 2);
}

TEST_F(ABRun, CallsNothingSlowerBeforeASecondRunTwiceAsLong) {
  const ComparisonReport report = run_ab(two_builds(made("base"), made("now", "f\\n", 1.2), ""), 10).report;
  EXPECT_EQ(exit_code(report.comparison), 1);
  ASSERT_TRUE(report.second.has_value());
  const auto lines = log();
  EXPECT_EQ(std::count(lines.begin(), lines.end(), "now ^(f)$"), 30);
}

TEST_F(ABRun, ComparesTwoMethodsUnderOneName) {
  const auto pairs = two_methods(made("a", "f\\ng\\n"), "f", "g");
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0].sides[0].benchmark, "f");
  EXPECT_EQ(pairs[0].sides[1].benchmark, "g");
  EXPECT_EQ(pairs[0].name, "g over f");
}

TEST_F(ABRun, TurnsTheOrderRoundEveryTime) {
  const fs::path a = made("a");
  const fs::path b = made("b");
  run_session({{"f", {{{a, "f"}, {b, "f"}}}}, {"g", {{{a, "g"}, {b, ""}}}}}, 2);
  EXPECT_THAT(log(), ElementsAre("a ^(f)$", "b ^(f)$", "a ^(g)$", "b ^(f)$", "a ^(f)$", "a ^(g)$"));
}

TEST_F(ABRun, MakesOneFileASideWithARepetitionARound) {
  const fs::path a = made("a");
  const SessionFiles files = run_session({{"common", {{{a, "f"}, {a, "g"}}}}}, 3);
  EXPECT_EQ(files[0]["context"]["session"], files[1]["context"]["session"]);
  for (const auto& file : files) {
    ASSERT_EQ(file["benchmarks"].size(), 3U);  // no aggregates
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(file["benchmarks"][i]["run_name"], "common");
      EXPECT_EQ(file["benchmarks"][i]["repetition_index"], i);
    }
  }
}

TEST_F(ABRun, OfTwoSessionsAreDistinguished) {
  const fs::path a = made("a");
  const auto session = [&] {
    return run_session({{"f", {{{a, "f"}, {a, "f"}}}}}, 1)[0]["context"]["session"];
  };
  EXPECT_NE(session(), session());
}

}  // namespace
}  // namespace slipstick::bench
