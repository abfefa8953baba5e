// Gates on published numbers.

#include "convergence/gates/gate.hpp"

#include <gmock/gmock.h>

#include "convergence/gates/gate_reader.hpp"
#include "convergence/gates/gate_report.hpp"
#include "convergence/gates/tests/made_gates.hpp"
#include "convergence/tests/scratch_folder.hpp"
#include "solver/input/tests/complaint.hpp"

namespace slipstick::convergence {
namespace {

using namespace testing;

/// A gate on an exact answer, which is good to `error`, relative.
Gate published(const std::string& text) {
  Gate gate = gate_on("exact.approach");
  Published published;
  published.number = read_printed(text).value();
  published.source = "Author (1900)";
  gate.bound = published;
  return gate;
}

Published& published_of(Gate& gate) { return std::get<Published>(gate.bound); }

Judgement judged(const Gate& gate, double ours, double error = 1e-14) {
  const Json result{{"status", "converged"},
                    {"exact", {{"approach", ours}, {"relative_uncertainty", error}}}};
  return judge_published(gate, result);
}

TEST(Published, DigitsAreThoseThatArePrinted) {
  const auto half_unit = [](const char* text) { return read_printed(text).value().half_unit; };
  EXPECT_DOUBLE_EQ(half_unit("1.0760"), 5e-5);
  EXPECT_DOUBLE_EQ(half_unit("1.076"), 5e-4);
  EXPECT_DOUBLE_EQ(half_unit("-8.155e-3"), 5e-7);
  EXPECT_DOUBLE_EQ(half_unit("10"), 0.5);
  EXPECT_DOUBLE_EQ(half_unit("2.36E+03"), 5.0);
  EXPECT_DOUBLE_EQ(read_printed("-8.155e-3")->value, -8.155e-3);
  EXPECT_DOUBLE_EQ(read_printed("2/3")->value, 2.0 / 3.0) << "a fraction is exact";
  EXPECT_LT(half_unit("2/3"), 1e-12);
  for (const char* const text :
       {"", "1,5", "about 2", "0x10", "1e9999", "nan", "1.2 m", ".5", "1/0", "1.5/2"}) {
    EXPECT_FALSE(read_printed(text)) << text;
  }
}

TEST(Published, AgreesWithinHalfAUnitOfItsLastDigit) {
  const Gate gate = published("1.0760");
  for (const double ours : {1.07596, 1.07604}) EXPECT_EQ(judged(gate, ours).outcome, Outcome::passed) << ours;
  for (const double ours : {1.07594, 1.07606, std::nan("")}) {
    EXPECT_NE(judged(gate, ours).outcome, Outcome::passed) << ours;
  }
  EXPECT_NEAR(published_json(judged(gate, 1.07604))["deviation"].get<double>(), 0.8, 1e-9);
}

TEST(Published, OwnErrorAndArgumentErrorWidenTheInterval) {
  Gate gate = published("1.0760");
  EXPECT_EQ(judged(gate, 1.07609, 3e-5).outcome, Outcome::failed);
  EXPECT_EQ(judged(gate, 1.07609, 4e-5).outcome, Outcome::passed);
  published_of(gate).argument_error = 2e-4;
  EXPECT_EQ(judged(gate, 1.0762).outcome, Outcome::passed);
  EXPECT_EQ(judged(gate, 1.0763).outcome, Outcome::failed);
}

/// An uncertainty of ours that is wider than the digits never makes a number agree; it may still differ.
TEST(Published, AnOwnErrorBeyondTheDigitsDecidesNothing) {
  Gate gate = published("1.0760");
  for (const double ours : {1.0760, 1.0761, 1.0765}) {
    const Judgement undeclared = judged(gate, ours, 1e-3);
    EXPECT_EQ(undeclared.outcome, Outcome::refused) << ours;
    EXPECT_THAT(undeclared.why, HasSubstr("21.5")) << ours;
    EXPECT_EQ(comparison_of(undeclared), std::nullopt);
  }
  EXPECT_EQ(judged(gate, 1.0775, 1e-3).outcome, Outcome::failed);
  published_of(gate).expected = Comparison::undecided;
  published_of(gate).why = "a coarse study";
  const Judgement declared = judged(gate, 1.0761, 1e-3);
  EXPECT_EQ(declared.outcome, Outcome::reported);
  EXPECT_EQ(comparison_of(declared), Comparison::undecided);
  EXPECT_NEAR(published_json(declared)["own_error_half_units"].get<double>(), 21.5, 0.1);
  EXPECT_EQ(exit_code({declared}), 0);
  EXPECT_THAT(gates_text({declared}), HasSubstr("0 agree, 0 differ for a known reason, 1 "));
  EXPECT_EQ(judged(gate, 1.0775, 1e-3).outcome, Outcome::failed) << "off by more than both";
  const Judgement agrees = judged(gate, 1.07601);
  EXPECT_EQ(agrees.outcome, Outcome::passed_unexpectedly);
  EXPECT_THAT(agrees.why, HasSubstr("undecided"));
  published_of(gate).expected = Comparison::differs;
  gate.status = GateStatus::expected_failure;
  EXPECT_EQ(judged(gate, 1.0761, 1e-3).outcome, Outcome::refused);
  EXPECT_EQ(judged(gate, 1.0775, 1e-3).outcome, Outcome::failed_as_expected)
      << "known to differ all the same";
  published_of(gate).argument_error = 2e-3;
  EXPECT_EQ(judged(gate, 1.0761, 1e-3).outcome, Outcome::passed_unexpectedly)
      << "the argument leaves more open";
}

TEST(Published, MayBeAFactorOrTheInverseOfOurs) {
  Gate gate = published("8.3");
  published_of(gate).times = 2.0;
  EXPECT_EQ(judged(gate, 4.17).outcome, Outcome::passed);
  EXPECT_EQ(judged(gate, 4.18).outcome, Outcome::failed);
  published_of(gate).inverse = true;
  EXPECT_EQ(judged(gate, 2.0 / 8.34).outcome, Outcome::passed);
  EXPECT_EQ(judged(gate, 2.0 / 8.36).outcome, Outcome::failed);
  const Json json = published_json(judged(gate, 2.0 / 8.34, 1e-3));
  EXPECT_NEAR(json["ours"].get<double>(), 8.34, 1e-12);
  EXPECT_NEAR(json["own_error"].get<double>(), 8.34e-3, 1e-12);
}

TEST(Published, KnownDifferenceMustBeThere) {
  Gate gate = with_status(published("0.9429"), GateStatus::expected_failure);
  published_of(gate).expected = Comparison::differs;
  EXPECT_EQ(judged(gate, 0.943198).outcome, Outcome::failed_as_expected);
  const Judgement agrees = judged(gate, 0.94291);
  EXPECT_EQ(agrees.outcome, Outcome::passed_unexpectedly);
  EXPECT_THAT(agrees.why, HasSubstr("differs"));
  EXPECT_EQ(judged(gate, std::nan("")).outcome, Outcome::failed) << "no number is no known difference";
}

TEST(Published, NumberWithoutAStatedErrorIsNotCompared) {
  Gate gate = published("1.0");
  gate.quantity = "approach";
  const Json result{{"status", "converged"}, {"approach", 1.0}, {"exact", {{"relative_uncertainty", 1e-14}}}};
  EXPECT_THAT(solver::complaint([&] { judge_published(gate, result); }), HasSubstr("approach"));
  published_of(gate).relative_error = 0.01;
  EXPECT_EQ(judge_published(gate, result).outcome, Outcome::passed);
  published_of(gate).relative_error.reset();
  const Json extrapolated{{"approach", {{"value", 1.04}, {"uncertainty", 0.01}}}};
  gate.quantity = "approach.value";
  EXPECT_EQ(judge_published(gate, extrapolated).outcome, Outcome::passed);
}

class LiteratureFile : public ScratchFolder {
 protected:
  static std::string row(const std::string& more) {
    return "[[gate]]\nid = \"a\"\nscene = \"s.toml\"\nquantity = \"exact.approach\"\n" + more + "\n";
  }
  std::string complaint(const std::string& more) const {
    return solver::complaint([&] { read_gates(write("bad.toml", row(more))); });
  }
};

TEST_F(LiteratureFile, SharesItsSourceAndKeepsItsDigits) {
  const std::vector<Gate> gates = read_gates(write("some.toml", R"([[group]]
published_in = "Author (1900), Table 2"
seen_in = "a later text"
scene = "s.toml"
times = 2
[[group.gate]]
id = "a"
quantity = "exact.approach"
published = "1.10"
[[group.gate]]
id = "b"
quantity = "exact.approach"
published = "3"
inverse = true
differs = "misprint"
[[group.gate]]
id = "c"
quantity = "area under a rough punch"
published = "7"
not_compared = "periodic there"
)"));
  const auto& first = std::get<Published>(gates[0].bound);
  EXPECT_EQ(first.number.text, "1.10");
  EXPECT_EQ(first.source, "Author (1900), Table 2");
  EXPECT_EQ(first.times, 2.0);
  EXPECT_TRUE(std::get<Published>(gates[1].bound).inverse);
  EXPECT_EQ(gates[1].status, GateStatus::expected_failure);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(gates[2].source));
}

TEST_F(LiteratureFile, ComplaintsNameTheKey) {
  const std::string in = "published_in = \"Author\"\n";
  EXPECT_THAT(complaint("published = \"1.1\""), AllOf(HasSubstr("bad.toml"), HasSubstr("published_in")));
  EXPECT_THAT(complaint(in + "published = \"one\""), AllOf(HasSubstr("published"), HasSubstr("one")));
  EXPECT_THAT(complaint(in + "published = 1.1"), HasSubstr("published"));
  EXPECT_THAT(complaint(in + "published = \"1.1\"\nbelow = 2"),
              AllOf(HasSubstr("below"), HasSubstr("published")));
  EXPECT_THAT(complaint(in + "published = \"1.1\"\nstatus = \"active\""), HasSubstr("status"));
  EXPECT_THAT(complaint(in + "published = \"1.1\"\ntimes = 0"), HasSubstr("times"));
  EXPECT_THAT(complaint(in + "published = \"1.1\"\nargument_error = -1"), HasSubstr("argument_error"));
  EXPECT_THAT(complaint(in + "published = \"1.1\"\nown_error = 0.1"),
              AllOf(HasSubstr("basis"), HasSubstr("own_error")));
  EXPECT_THAT(complaint(in + "published = \"1.1\"\ndiffers = \"a\"\nnot_compared = \"b\""),
              AllOf(HasSubstr("not_compared"), HasSubstr("differs")));
  EXPECT_THAT(complaint(in + "published = \"1.1\"\ndiffers = \"a\"\nundecided = \"b\""),
              AllOf(HasSubstr("undecided"), HasSubstr("differs")));
}

}  // namespace
}  // namespace slipstick::convergence
