#include "convergence/report/scene_verdict.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "convergence/orders/order.hpp"
#include "convergence/report/validation.hpp"
#include "convergence/studies/study_result.hpp"

namespace slipstick::convergence {
namespace {

Judgement gate(const char* id, Outcome outcome, double factor) {
  Judgement judgement;
  judgement.gate.id = id;
  judgement.outcome = outcome;
  judgement.factor = factor;
  return judgement;
}

void set_verdict(PaperValidation& paper, std::size_t row, HardVerdict verdict) {
  paper.hard.rows[row].hard = {.family = "f", .why = "", .name = "c", .run = {}};
  paper.hard.rows[row].judged = {verdict, "why", {}};
}

/// A made validation in which everything holds.
PaperValidation paper() {
  PaperValidation found;
  found.hard.rows.resize(3);
  for (const std::size_t i : {0U, 1U, 2U}) set_verdict(found, i, i < 2 ? HardVerdict::certified : HardVerdict::refused);
  found.peers = {{.program = "P", .expected = "good", .verdict = "good"},
                 {.program = "Q", .expected = "bad", .verdict = "bad"}};
  found.gates = {gate("wide", Outcome::passed, 0.1), gate("known", Outcome::failed_as_expected, 30.0),
                 gate("narrow", Outcome::passed, 0.8)};
  found.literature = *found.gates;
  return found;
}

Headline headline(const PaperValidation& paper, double twist = 1e-5, const char* commit = "abc") {
  Page page;
  page.provenance = {{"commit", commit}};
  page.numbers = {{.key = "twist_angle", .value = twist}};
  return headline_of(judge_validation(paper), counts_json(paper), page);
}

bool says(const Headline& headline, const std::string& words) {
  return std::ranges::any_of(headline.findings,
                             [&](const Finding& finding) { return finding.line.find(words) != std::string::npos; });
}

TEST(Headline, IsGoodWhereEverythingHolds) {
  const Headline found = headline(paper());
  EXPECT_EQ(found.verdict(), "good");
  EXPECT_TRUE(says(found, "2 of 3 pass"));
  EXPECT_TRUE(says(found, "narrow, at 80 %"));
  EXPECT_TRUE(says(found, "2 of 3 certified, 1 refused"));
  EXPECT_TRUE(says(found, "P is good, Q is bad"));
  EXPECT_TRUE(says(found, "2 of 3 published numbers"));
}

TEST(Headline, IsBadWhereAnythingFails) {
  const auto expect_bad = [](const char* words, const auto& change) {
    PaperValidation changed = paper();
    change(changed);
    EXPECT_EQ(headline(changed).verdict(), "bad") << words;
    EXPECT_TRUE(says(headline(changed), words)) << words;
  };
  for (const HardVerdict verdict : {HardVerdict::wrong, HardVerdict::not_converged})
    expect_bad("f c: why", [&](auto& made) { set_verdict(made, 1, verdict); });
  expect_bad("; wide failed", [](auto& made) { made.gates->front().outcome = Outcome::failed; });
  expect_bad("; known passed unexpectedly",
             [](auto& made) { made.literature[1].outcome = Outcome::passed_unexpectedly; });
  expect_bad("Q is good (known to be bad)", [](auto& made) { made.peers[1].verdict = "good"; });
}

/// A validation without gates.
PaperValidation quick() {
  PaperValidation found = paper();
  found.gates.reset();
  return found;
}

TEST(HeadlineChanges, NameEachDifferenceAndEachPartThatOneOfThemOmits) {
  const Json before = to_json(headline(paper()));
  const Json omits = to_json(headline(quick()));
  EXPECT_EQ(omits["verdict"], "good");
  EXPECT_TRUE(omits["counts"]["gates"].is_null());
  EXPECT_FALSE(omits["counts"]["gates_reason"].empty());
  EXPECT_TRUE(changes(headline(paper(), 1.005e-5), before).empty());  // by rounding
  PaperValidation other = paper();
  other.hard.rows.erase(other.hard.rows.begin());
  EXPECT_EQ(changes(headline(other, 2e-5), before),
            (std::vector<std::string>{"hard scenes certified: 2 before, 1 now",
                                      "twist angle: 1.00e-05 before, 2.00e-05 now"}));
  for (const auto& found : {changes(headline(paper()), omits), changes(headline(quick()), before)})
    EXPECT_THAT(found, testing::ElementsAre(testing::StartsWith("gates: ")));
}

/// The same command twice keeps the changes that the first one found.
TEST(HeadlineChanges, StayWhereNothingMoreHasChanged) {
  PaperValidation later = paper();
  later.hard.rows.push_back(later.hard.rows.front());
  const Headline first = with_changes(headline(paper()), nullptr);
  EXPECT_EQ(first.since, "");
  const Headline second = with_changes(headline(later, 1e-5, "def"), to_json(first));
  EXPECT_EQ(second.since, "abc");
  ASSERT_EQ(second.changes.size(), 1U);
  const Headline again = with_changes(headline(later, 1e-5, "def"), to_json(second));
  EXPECT_EQ(again.since, "abc");
  EXPECT_EQ(again.changes, second.changes);
}

/// A study of meshes with an order of the twist.
StudyResult study_with(OrderVerdict verdict, double low, double high, double expected = 2.0) {
  QuantityResult twist{.path = "twist_angle"};
  twist.order = {
      .value = 0.5 * (low + high), .low = low, .high = high, .constant = 1.0, .verdict = verdict, .why = "so"};
  twist.expected.value = expected;
  SeriesResult series{.name = "one"};
  series.quantities.push_back(twist);
  StudyResult study;
  study.series.push_back(series);
  return study;
}

/// An order holds if its interval is not below the expected one; a wide interval is open.
TEST(Order, CountsOnlyWhereItIsShown) {
  struct Case {
    OrderVerdict verdict;
    double low, high;
    Shown shown;
    double expected = 2.0;
  };
  using enum OrderVerdict;
  for (const auto& [verdict, low, high, shown, expected] :
       {Case{asymptotic, 1.6, 2.5, Shown::holds}, Case{superconvergent, 2.4, 2.6, Shown::holds},
        Case{preasymptotic, 1.2, 1.6, Shown::fails}, Case{preasymptotic, 0.5, 3.0, Shown::open},
        Case{oscillatory, -1.7, 16.0, Shown::open}, Case{too_few, -1.7, 16.0, Shown::open},
        Case{OrderVerdict::floor, -1.7, 16.0, Shown::open}, Case{preasymptotic, 1.9, 2.1, Shown::open, kNaN}}) {
    const Finding found = judge_order(study_with(verdict, low, high, expected), "twist_angle", "twist");
    EXPECT_EQ(found.shown, shown) << to_string(verdict) << low;
  }
  EXPECT_EQ(judge_order(study_with(asymptotic, 1.9, 2.1), "stick_radius", "stick").shown, Shown::open);
}

/// A number of a page with its errors by the mesh and by the steps.
std::vector<PageNumber> numbers_with(double mesh, double path) {
  return {{.key = "twist_angle",
           .words = "twist",
           .basis = "so",
           .error = number_or(mesh + path, "so"),
           .mesh = number_or(mesh, "so"),
           .path = number_or(path, "so")}};
}

/// The errors by mesh and steps are added; an unknown error exceeds every bound.
TEST(Accuracy, IsThatOfMeshAndSteps) {
  const auto wanted = [](const std::vector<PageNumber>& numbers, double error) {
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

TEST(Headline, IsOpenWhereAFindingIsOpen) {
  const Headline open{.findings = {{"A", "a"}, {"B", "b", Shown::open}}};
  EXPECT_EQ(open.verdict(), "open");
  EXPECT_EQ(headline_text(open).find("All is well"), std::string::npos);
  const Headline bad{.findings = {{"A", "a", Shown::fails}, {"B", "b", Shown::open}}};
  EXPECT_EQ(bad.verdict(), "bad");
}

TEST(Headline, MakesACaseOfEachFinding) {
  Page page;
  page.headline.findings = {{"A", "a"}, {"B", "b", Shown::open}, {"C", "c", Shown::fails}};
  std::vector<CaseVerdict> verdicts;
  for (const JunitCase& each : page_cases(page)) verdicts.push_back(each.verdict);
  EXPECT_EQ(verdicts, (std::vector{CaseVerdict::passed, CaseVerdict::skipped, CaseVerdict::failure}));
}

TEST(HeadlineText, HasTheVerdictAndAFewChanges) {
  const Headline first = with_changes(headline(paper()), nullptr);
  EXPECT_EQ(headline_text(first).rfind("All is well\n", 0), 0U);
  Json before = to_json(first);
  before["numbers"]["twist_angle"] = 1.0;
  for (const char* key : {"certified", "refused"}) before["counts"]["hard_scenes"][key] = 7;
  PaperValidation now = paper();
  now.hard.rows.push_back({});
  set_verdict(now, 3, HardVerdict::wrong);
  const std::string text = headline_text(with_changes(headline(now), before));
  EXPECT_EQ(text.rfind("NOT all is well\n", 0), 0U);
  // Verdict, check, three counts and a number differ.
  EXPECT_NE(text.find("and 3 more\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace slipstick::convergence
