// Texts, JUnit, Markdown and JSON of judged gates.

#include <gmock/gmock.h>

#include "convergence/gates/gate_report.hpp"
#include "convergence/gates/tests/made_gates.hpp"
#include "convergence/results/output.hpp"

namespace slipstick::convergence {
namespace {

using namespace testing;

// Every kind of gate, with all that Markdown takes for markup.
std::vector<Judgement> one_of_each() {
  const auto named = [](Gate gate, const std::string& id) {
    gate.id = id;
    return gate;
  };
  std::vector<Judgement> judgements{
      judge(named(below("x", 1.0), "good"), solve_with("x", 0.5)),
      judge(named(below("x", 1.0), "bad <a> & \"b\" | c, d: 100 %"), solve_with("x", 4.0)),
      judge(with_status(named(below("x", 1.0), "known"), GateStatus::expected_failure), solve_with("x", 2.0)),
      judge(with_status(named(below("x", 1.0), "repaired"), GateStatus::expected_failure),
            solve_with("x", 0.5)),
      judge(with_status(named(below("x", 1.0), "watched"), GateStatus::report_only), solve_with("x", 3.0)),
      refuse(named(below("x", 1.0), "unreadable"), "no\nsuch \x01 scene <here>"),
  };
  judgements[1].dominant_error = "discretisation";
  judgements[1].seconds = 1.5;
  judgements[2].gate.file = "gates/other.toml";
  return judgements;
}

TEST(GateReport, TextExplainsWhatDoesNotPass) {
  const std::string text = gates_text(one_of_each());
  EXPECT_THAT(text, AllOf(HasSubstr("x is 4"), HasSubstr("discretisation"),
                          HasSubstr("users read this number"), HasSubstr("measured 1e-6, factor 10"),
                          HasSubstr("slipstick gate gates/some.toml --only 'bad <a> & \"b\" | c, d: 100 %'"),
                          HasSubstr("slipstick gate gates/some.toml --only repaired")));
  EXPECT_THAT(
      text,
      HasSubstr("6 gates: 1 passed, 1 failed as expected, 1 reported, 1 refused, 1 passed unexpectedly, "
                "1 failed\n"));
  EXPECT_THAT(text, Not(HasSubstr("--only good")));
}

/// Failing gates, gate i by the factor 2 + i, in an order that hides the worst.
std::vector<Judgement> many_failures(int count) {
  std::vector<Judgement> judgements;
  for (int i = 0; i < count; ++i) {
    Gate gate = below("x", 1.0);
    const int rank = (i * 7919) % count;
    gate.id = "gate-" + std::to_string(rank);
    judgements.push_back(judge(gate, solve_with("x", 2.0 + rank)));
  }
  return judgements;
}

TEST(GateReport, MarkdownStaysBelow64kBWithTheWorstFirst) {
  const std::string text = gates_markdown(many_failures(5000));
  EXPECT_LT(text.size(), 64000U);
  EXPECT_GT(text.size(), 60000U) << "cut off earlier than needed";
  std::istringstream lines(text);
  std::string line;
  int expected = 4999;
  int rows = 0;
  while (std::getline(lines, line)) {
    if (!line.starts_with("| failed | ")) continue;
    EXPECT_THAT(line, HasSubstr("| gate-" + std::to_string(expected--) + " |"));
    ++rows;
  }
  EXPECT_THAT(text, HasSubstr(std::to_string(5000 - rows) + " more gates"));
  EXPECT_THAT(text, HasSubstr("5000 gates: 5000 failed"));
}

TEST(GateReport, MarkdownHoldsEveryGateInItsOrderOfBadness) {
  const std::string text = gates_markdown(one_of_each());
  std::size_t last = 0;
  for (const char* id : {"bad &lt;a>", "repaired", "unreadable", "watched", "known", "| good |"}) {
    const std::size_t at = text.find(id);
    ASSERT_NE(at, std::string::npos) << id;
    EXPECT_GT(at, last) << id;
    last = at;
  }
  std::istringstream lines(text);
  std::string line;
  while (std::getline(lines, line)) {
    if (!line.starts_with("|")) continue;
    const int in_id = line.find("\\|") != std::string::npos ? 2 : 0;  // and again to rerun it
    EXPECT_EQ(std::ranges::count(line, '|'), 8 + in_id) << line;
  }
  EXPECT_THAT(text, Not(HasSubstr("more gates")));
}

/// Ids and reasons are text of strangers: no image, link, mention, sequence of a terminal or turned direction
/// comes out of any file.
TEST(GateReport, WhatAStrangerWroteStaysText) {
  const std::string bad =
      "![x](http://a.b/c) [y](javascript:z) <javascript:z> @user #12 www.a.b https://a.b &#64;user "
      "`code` **b** \x1b[31m \u009b31m \u202etxet\u2066 \u2028 \u061c";
  Gate gate = below("x", 1.0);
  gate.id = gate.reason = bad;
  std::vector<Judgement> judgements{judge(gate, solve_with("x", 4.0))};
  const std::string markdown = gates_markdown(judgements);
  EXPECT_THAT(markdown, Not(AnyOf(HasSubstr("[x]("), HasSubstr("http://"), HasSubstr("https://"))));
  const std::string opening = R"(\[y\](javascript:z))";
  EXPECT_THAT(markdown, HasSubstr(opening));
  for (const char* markup : {"@user", "#12", "www.", "&#64;", " <", " `code", " **"}) {
    EXPECT_THAT(markdown, Not(HasSubstr(markup)));
  }
  for (const std::string& text : {markdown, gates_junit(judgements), plain_text(gates_text(judgements))}) {
    for (const char* steers : {"\x1b", "\u009b", "\u202e", "\u2066", "\u2028", "\u061c"}) {
      EXPECT_THAT(text, Not(HasSubstr(steers)));
    }
    EXPECT_THAT(text, HasSubstr("u202etxet"));
  }
}

TEST(GateReport, JsonHasEveryNumberOrAReason) {
  const Json json = gates_json(one_of_each());
  EXPECT_EQ(json["exit_code"], 2);
  EXPECT_EQ(json["counts"]["failed"], 1);
  ASSERT_EQ(json["gates"].size(), 6);
  EXPECT_EQ(json["gates"][1]["value"], 4.0);
  EXPECT_EQ(json["gates"][1]["factor"], 4.0);
  EXPECT_EQ(json["gates"][1]["outcome"], "failed");
  EXPECT_TRUE(json["gates"][5]["value"].is_null());
  EXPECT_THAT(json["gates"][5]["value_reason"].get<std::string>(), HasSubstr("scene"));
}

}  // namespace
}  // namespace slipstick::convergence
