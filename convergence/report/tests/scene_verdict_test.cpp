#include "convergence/report/scene_verdict.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "convergence/orders/mesh_sequence.hpp"
#include "convergence/results/result_parts.hpp"

namespace slipstick::convergence {
namespace {

Json gate(const char* id, const char* outcome, double factor) {
  return {{"id", id}, {"outcome", outcome}, {"factor", factor}};
}

/// What a made-up validation found: all is well.
Json paper() {
  Json found;
  found["hard"]["rows"] = Json::array_t(3, Json{{"verdict", "certified"}});
  found["hard"]["counts"] = {{"certified", 2}, {"refused", 1}, {"not_converged", 0}, {"wrong", 0}};
  found["peers"] = {{{"program", "P"}, {"verdict", "good"}, {"expected", "good"}},
                    {{"program", "Q"}, {"verdict", "bad"}, {"expected", "bad"}}};
  found["gates"]["exit_code"] = 0;
  found["gates"]["counts"] = {{"passed", 2}, {"failed as expected", 1}};
  found["gates"]["gates"] = {gate("wide", "passed", 0.1), gate("known", "failed as expected", 30.0),
                             gate("narrow", "passed", 0.8)};
  found["literature"] = found["gates"];
  return found;
}

Json headline(const Json& paper, double twist = 1e-5, const char* commit = "abc") {
  Json page;
  page["provenance"]["commit"] = commit;
  page["numbers"] = Json::array({Json{{"key", "twist_angle"}, {"value", twist}}});
  page["paper"] = paper;
  return headline_of(judge_validation(paper), page);
}

bool says(const Json& headline, const std::string& words) {
  return std::ranges::any_of(headline["lines"], [&](const Json& line) {
    return line[1].get<std::string>().find(words) != std::string::npos;
  });
}

TEST(Headline, IsGoodWhereAllIsAsItShould) {
  const Json found = headline(paper());
  EXPECT_EQ(found["verdict"], "good");
  EXPECT_TRUE(
      says(found, "2 of 3 pass, 1 fails as it should; nearest to its bound is narrow, at 80 % of it"));
  EXPECT_TRUE(says(found, "2 of 3 certified, 1 refused with a reason, 0 not converged, 0 wrong"));
  EXPECT_TRUE(says(found, "P is good, Q is bad"));
  EXPECT_TRUE(says(found, "2 of 3 published numbers agree at their digits, 1 differ for a known reason"));
}

TEST(Headline, IsBadWhereAnythingIsNot) {
  for (const char* count : {"wrong", "not_converged"}) {
    Json changed = paper();
    changed["hard"]["counts"][count] = 1;
    changed["hard"]["rows"][1] = {{"family", "f"}, {"case", "c"}, {"verdict", count}, {"reason", "why"}};
    EXPECT_EQ(headline(changed)["verdict"], "bad") << count;
    EXPECT_TRUE(says(headline(changed), "f c: why"));
  }
  Json gates = paper();
  gates["gates"]["exit_code"] = 1;
  gates["gates"]["gates"][0]["outcome"] = "failed";
  EXPECT_EQ(headline(gates)["verdict"], "bad");
  EXPECT_TRUE(says(headline(gates), "; wide failed"));
  Json literature = paper();
  literature["literature"]["exit_code"] = 1;
  literature["literature"]["gates"][1]["outcome"] = "passed unexpectedly";
  EXPECT_EQ(headline(literature)["verdict"], "bad");
  EXPECT_TRUE(says(headline(literature), "; known passed unexpectedly"));
  Json peer = paper();
  peer["peers"][1]["verdict"] = "good";
  EXPECT_EQ(headline(peer)["verdict"], "bad");
  EXPECT_TRUE(says(headline(peer), "Q is good (known to be bad)"));
}

TEST(Headline, SaysThatGatesWereLeftOut) {
  Json quick = paper();
  quick.erase("gates");
  const Json found = headline(quick);
  EXPECT_EQ(found["verdict"], "good");
  EXPECT_TRUE(found["counts"]["gates"].is_null());
  EXPECT_TRUE(says(found, "left out"));
}

TEST(HeadlineChanges, AreNoneOfWhatRoundingMoves) {
  EXPECT_TRUE(changes(headline(paper(), 1.005e-5), headline(paper())).empty());
}

TEST(HeadlineChanges, NameWhatIsDifferent) {
  Json other = paper();
  other["hard"]["counts"]["certified"] = 1;
  EXPECT_EQ(
      changes(headline(other, 2e-5), headline(paper())),
      Json::array({"hard scenes certified: 2 before, 1 now", "twist angle: 1.00e-05 before, 2.00e-05 now"}));
}

TEST(HeadlineChanges, NameAPartThatOneOfThemLeavesOut) {
  Json quick = paper();
  quick.erase("gates");
  EXPECT_EQ(changes(headline(paper()), headline(quick)), Json::array({"gates: left out before"}));
  EXPECT_EQ(changes(headline(quick), headline(paper())), Json::array({"gates: left out now"}));
}

/// The same command twice must not hide what the first of the two found.
TEST(HeadlineChanges, StayWhereNothingMoreHasChanged) {
  Json later = paper();
  later["hard"]["counts"]["certified"] = 3;
  const Json first = with_changes(headline(paper()), nullptr);
  EXPECT_TRUE(first["since"].is_null());
  const Json second = with_changes(headline(later, 1e-5, "def"), first);
  EXPECT_EQ(second["since"], "abc");
  ASSERT_EQ(second["changes"].size(), 1U);
  const Json again = with_changes(headline(later, 1e-5, "def"), second);
  EXPECT_EQ(again["since"], "abc");
  EXPECT_EQ(again["changes"], second["changes"]);
}

/// A study of meshes with such an order of the twist.
Json study_with(const char* verdict, double low, double high, const Json& expected = 2.0) {
  Json order{{"verdict", verdict}, {"low", low}, {"high", high}, {"expected", expected}, {"why", "so"}};
  order["value"] = 0.5 * (low + high);
  return Json::array({Json{{"series", {{"one", {{"order", {{"twist_angle", order}}}}}}}}});
}

Shown order_of(const Json& studies) { return judge_order(studies, "twist_angle", "twist").shown; }

/// An order counts where its interval lies no lower than expected; one that could be anything shows nothing.
TEST(Order, CountsOnlyWhereItIsShown) {
  EXPECT_EQ(order_of(study_with("asymptotic", 1.6, 2.5)), Shown::holds) << "agrees with what is expected";
  EXPECT_EQ(order_of(study_with("superconvergent", 2.4, 2.6)), Shown::holds);
  EXPECT_EQ(order_of(study_with("preasymptotic", 1.2, 1.6)), Shown::fails);
  EXPECT_EQ(order_of(study_with("preasymptotic", 0.5, 3.0)), Shown::open);
  for (const char* verdict : {"oscillatory", "too_few", "floor"}) {
    EXPECT_EQ(order_of(study_with(verdict, -1.7, 16.0)), Shown::open) << verdict;
  }
  EXPECT_EQ(order_of(study_with("preasymptotic", 1.9, 2.1, nullptr)), Shown::open) << "none is expected";
  EXPECT_EQ(judge_order(study_with("asymptotic", 1.9, 2.1), "stick_radius", "stick radius").shown,
            Shown::open);
}

/// A number of a page with an error of so much by the mesh and by the steps; NaN: not known.
Json numbers_with(double mesh, double path) {
  Json row{{"key", "twist_angle"}, {"words", "twist"}, {"basis", "so"}};
  set_number(row, "mesh", mesh, "so");
  set_number(row, "path", path, "so");
  set_number(row, "error", mesh + path, "so");
  return Json::array({row});
}

/// Mesh and steps count together; an unknown error is never within a wanted one.
TEST(Accuracy, IsThatOfMeshAndSteps) {
  const auto wanted = [](const Json& numbers, double error) {
    return judge_wanted({"twist_angle", error}, numbers);
  };
  EXPECT_EQ(wanted(numbers_with(4e-3, 5e-3), 1e-2).shown, Shown::holds);
  EXPECT_EQ(wanted(numbers_with(4e-3, 9e-3), 1e-2).shown, Shown::fails);
  EXPECT_NE(wanted(numbers_with(4e-3, 9e-3), 1e-2).line.find("solver.substeps 2 times"), std::string::npos);
  EXPECT_NE(wanted(numbers_with(4e-2, 9e-3), 1e-2).line.find("grid.cells"), std::string::npos);
  EXPECT_EQ(wanted(numbers_with(4e-3, kNaN), 0.5).shown, Shown::fails);
  EXPECT_EQ(judge_accuracy(numbers_with(4e-3, 9e-3), "twist_angle").shown, Shown::holds);
  EXPECT_EQ(judge_accuracy(numbers_with(4e-3, 1.2), "twist_angle").shown, Shown::open);
  EXPECT_EQ(judge_accuracy(numbers_with(4e-3, kNaN), "twist_angle").shown, Shown::open);
  EXPECT_EQ(judge_accuracy(numbers_with(4e-3, 0.0), "moment").shown, Shown::open);
}

/// Something open is not wrong, and not all is well.
TEST(Headline, IsOpenWhereSomethingIsNotShown) {
  Json page;
  page["provenance"]["commit"] = "abc";
  page["numbers"] = Json::array();
  const auto verdict = [&](std::vector<Finding> findings) {
    return with_changes(headline_of(findings, page), nullptr);
  };
  const Json open = verdict({{"A", "a"}, {"B", "b", Shown::open}});
  EXPECT_EQ(open["verdict"], "open");
  EXPECT_EQ(headline_text(open).find("All is well"), std::string::npos);
  EXPECT_EQ(verdict({{"A", "a", Shown::fails}, {"B", "b", Shown::open}})["verdict"], "bad");
}

TEST(HeadlineText, SaysTheVerdictAndAFewChanges) {
  Json before = with_changes(headline(paper()), nullptr);
  EXPECT_EQ(headline_text(before).rfind("All is well\n", 0), 0U);
  before["numbers"]["twist_angle"] = 1.0;
  for (const char* key : {"certified", "refused"}) before["counts"]["hard_scenes"][key] = 7;
  Json now = paper();
  now["hard"]["counts"]["wrong"] = 1;
  const std::string text = headline_text(with_changes(headline(now), before));
  EXPECT_EQ(text.rfind("NOT all is well\n", 0), 0U);
  // Verdict, check, three counts and a number differ.
  EXPECT_NE(text.find("and 3 more\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace slipstick::convergence
