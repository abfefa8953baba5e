#include "bench/compare/ab_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "bench/compare/tests/made_program.hpp"
#include "convergence/programs/temporary_folder.hpp"

namespace slipstick::bench {
namespace {

using testing::lines_of;
using testing::made_program;

std::vector<std::string> names(const std::vector<Heat>& heats) {
  std::vector<std::string> found;
  for (const Heat& heat : heats) {
    EXPECT_EQ(heat.size(), 2U);
    found.push_back(heat[0].benchmark + "|" + heat[1].benchmark);
  }
  return found;
}

TEST(Contest, HasTheBenchmarksOfEitherBuild) {
  const convergence::TemporaryFolder folder;
  const auto base = made_program(folder / "", "base", "common\\nold\\n");
  const auto now = made_program(folder / "", "now", "new\\ncommon\\n");
  EXPECT_THAT(names(two_builds(base, now, "")), ::testing::ElementsAre("common|common", "old|", "|new"));
}

TEST(Contest, ReportsABenchmarkThatIsInOneBuildOnly) {
  const convergence::TemporaryFolder folder;
  const auto base = made_program(folder / "", "base", "common\\nold\\n");
  const auto now = made_program(folder / "", "now", "common\\nnew\\n", 1.01);
  const ContestResult result = hold_contest({.heats = two_builds(base, now, ""), .rounds = 10});
  EXPECT_THAT(result.report.comparison.obstacles, ::testing::IsEmpty());
  std::vector<std::string> findings;
  for (const auto& found : result.report.comparison.benchmarks) {
    findings.push_back(found.name + ": " + to_string(found.finding));
  }
  EXPECT_THAT(findings, ::testing::ElementsAre("common: same", "old: only in base", "new: only in new"));
  EXPECT_EQ(exit_code(result.report.comparison), 2);
}

TEST(Contest, CallsNothingSlowerBeforeASecondRunTwiceAsLong) {
  const convergence::TemporaryFolder folder;
  const auto base = made_program(folder / "", "base", "f\\n", 1.0);
  const auto now = made_program(folder / "", "now", "f\\n", 1.2);
  const ContestResult result = hold_contest({.heats = two_builds(base, now, ""), .rounds = 10});
  EXPECT_EQ(exit_code(result.report.comparison), 1);
  ASSERT_TRUE(result.report.second.has_value());
  const auto lines = lines_of(folder / "log");
  EXPECT_EQ(std::count(lines.begin(), lines.end(), "now ^(f)$"), 30);
}

TEST(Contest, ComparesTwoMethodsUnderOneName) {
  const convergence::TemporaryFolder folder;
  const auto program = made_program(folder / "", "a", "f\\ng\\n");
  const auto heats = two_methods(program, "f", "g");
  ASSERT_EQ(heats.size(), 1U);
  EXPECT_EQ(heats[0][0].benchmark, "f");
  EXPECT_EQ(heats[0][1].benchmark, "g");
  EXPECT_EQ(heats[0][0].name, "g over f");
  EXPECT_EQ(heats[0][1].name, "g over f");
}

}  // namespace
}  // namespace slipstick::bench
