#include "convergence/report/headline.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>

#include "convergence/results/result_parts.hpp"

namespace slipstick::convergence {
namespace {

Json gate(const char* id, const char* outcome, double factor) {
  return {{"id", id}, {"outcome", outcome}, {"factor", factor}};
}

Json mesh(int cells, const char* pressure, double moment_ratio, double error) {
  return {
      {"pressure", pressure},        {"moment_ratio", moment_ratio},      {"cells", {cells, cells}},
      {"twist_error", error},        {"stick_radius_error", 2.0 * error}, {"certificate", {{"gap", 1e-9}}},
      {"seconds", {{"total", 0.25}}}};
}

/// A made-up report in which all is well.
Json report() {
  Json found;
  found["provenance"]["commit"] = "abc";
  found["mesh"] = {mesh(256, "solved", 0.9, 1e-5), mesh(512, "solved", 0.5, 1e-7),
                   mesh(64, "solved", 0.9, 1e-3), mesh(512, "hertz", 0.9, 1e-6)};
  found["hard"]["rows"] = Json::array({1, 2, 3});
  found["hard"]["counts"] = {{"certified", 2}, {"refused", 1}, {"not_converged", 0}, {"wrong", 0}};
  found["studies"] = Json::array();
  found["peers"] = {{{"program", "P"}, {"verdict", "good"}, {"expected", "good"}},
                    {{"program", "Q"}, {"verdict", "bad"}, {"expected", "bad"}}};
  found["gates"]["exit_code"] = 0;
  found["gates"]["counts"] = {{"passed", 2}, {"failed as expected", 1}};
  found["gates"]["gates"] = {gate("wide", "passed", 0.1), gate("known", "failed as expected", 30.0),
                             gate("narrow", "passed", 0.8)};
  return found;
}

bool says(const Json& lines, const std::string& words) {
  for (const Json& line : lines) {
    if (line[1].get<std::string>().find(words) != std::string::npos) return true;
  }
  return false;
}

TEST(Headline, IsGoodWhereAllIsAsItShould) {
  const Json found = headline(report());
  EXPECT_EQ(found["verdict"], "good");
  EXPECT_TRUE(says(found["lines"],
                   "2 of 3 pass, 1 fails as it should; nearest to its bound is narrow, at 80 % of it"));
  EXPECT_TRUE(says(found["lines"], "2 of 3 certified, 1 refused with a reason, 0 not converged, 0 wrong"));
  EXPECT_TRUE(says(found["lines"], "P is good, Q is bad"));
}

TEST(Headline, RemembersTheFinestMeshOfThePapersSphere) {
  const Json numbers = headline(report())["numbers"];
  EXPECT_EQ(numbers["cells"][0], 256);
  EXPECT_EQ(numbers["twist_error"], 1e-5);
  EXPECT_EQ(numbers["stick_radius_error"], 2e-5);
  EXPECT_EQ(numbers["gap"], 1e-9);
  EXPECT_EQ(numbers["seconds"], 0.25);
}

TEST(Headline, IsBadWhereAnythingIsNot) {
  const auto verdict = [](const Json& changed) { return headline(changed)["verdict"]; };
  for (const char* count : {"wrong", "not_converged"}) {
    Json changed = report();
    changed["hard"]["counts"][count] = 1;
    EXPECT_EQ(verdict(changed), "bad") << count;
  }
  Json gates = report();
  gates["gates"]["exit_code"] = 1;
  gates["gates"]["gates"][0]["outcome"] = "failed";
  EXPECT_EQ(verdict(gates), "bad");
  EXPECT_TRUE(says(headline(gates)["lines"], "wrong: wide"));
  Json peer = report();
  peer["peers"][1]["verdict"] = "good";
  EXPECT_EQ(verdict(peer), "bad");
  EXPECT_TRUE(says(headline(peer)["lines"], "Q is good (known to be bad)"));
  Json study = report();
  study["studies"].push_back(
      {{"name", "s"},
       {"failed_runs", {{"count", 1}, {"of", 5}, {"first", {{"run", "r"}, {"message", "died"}}}}}});
  EXPECT_EQ(verdict(study), "bad");
}

TEST(Headline, SaysThatGatesWereLeftOut) {
  Json quick = report();
  quick.erase("gates");
  const Json found = headline(quick);
  EXPECT_EQ(found["verdict"], "good");
  EXPECT_TRUE(found["counts"]["gates"].is_null());
  EXPECT_TRUE(says(found["lines"], "left out"));
}

TEST(HeadlineChanges, AreNoneOfTimesAndWhatRoundingMoves) {
  Json other = report();
  other["mesh"][0]["seconds"]["total"] = 100.0;
  other["mesh"][0]["twist_error"] = 1.005e-5;
  EXPECT_TRUE(changes(headline(other), headline(report())).empty());
}

TEST(HeadlineChanges, NameWhatIsDifferent) {
  Json other = report();
  other["mesh"][0]["twist_error"] = 2e-5;
  other["hard"]["counts"]["certified"] = 1;
  const Json found = changes(headline(other), headline(report()));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0], "hard certified: 2 before, 1 now");
  EXPECT_EQ(found[1], "twist error: 1.00e-05 before, 2.00e-05 now");
}

TEST(HeadlineChanges, NameAPartThatOneOfThemLeavesOut) {
  Json quick = report();
  quick.erase("gates");
  const Json before = changes(headline(report()), headline(quick));
  ASSERT_EQ(before.size(), 1U);
  EXPECT_EQ(before[0], "gates: left out before");
  const Json now = changes(headline(quick), headline(report()));
  ASSERT_EQ(now.size(), 1U);
  EXPECT_EQ(now[0], "gates: left out now");
}

/// The same command twice must not hide what the first of the two found.
TEST(HeadlineChanges, StayWhereNothingMoreHasChanged) {
  Json later = report();
  later["provenance"]["commit"] = "def";
  later["hard"]["counts"]["certified"] = 3;
  const Json first = with_changes(headline(report()), nullptr);
  EXPECT_TRUE(first["since"].is_null());
  const Json second = with_changes(headline(later), first);
  EXPECT_EQ(second["since"], "abc");
  ASSERT_EQ(second["changes"].size(), 1U);
  const Json again = with_changes(headline(later), second);
  EXPECT_EQ(again["since"], "abc");
  EXPECT_EQ(again["changes"], second["changes"]);
}

TEST(HeadlineText, HasTenLinesAtMost) {
  Json before = with_changes(headline(report()), nullptr);
  EXPECT_EQ(headline_text(before).rfind("All is well\n", 0), 0U);
  for (const char* key : {"twist_error", "stick_radius_error", "gap"}) before["numbers"][key] = 1.0;
  before["counts"]["hard"]["certified"] = 7;
  Json now = report();
  now["hard"]["counts"]["wrong"] = 1;
  const std::string text = headline_text(with_changes(headline(now), before));
  EXPECT_EQ(text.rfind("NOT all is well\n", 0), 0U);
  EXPECT_NE(text.find("more\n"), std::string::npos);
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 10);
}

}  // namespace
}  // namespace slipstick::convergence
