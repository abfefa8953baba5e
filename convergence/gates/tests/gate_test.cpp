// Outcomes of gates: bounds, references, failed solves.

#include <gmock/gmock.h>

#include <cmath>

#include "convergence/gates/tests/made_gates.hpp"

namespace slipstick::convergence {
namespace {

using namespace testing;

Outcome outcome(const Gate& gate, const Json& value) {
  return judge(gate, solve_with(gate.quantity, value)).outcome;
}

TEST(Gate, BelowBoundsTheSize) {
  const Gate gate = below("twist_error", 2e-5);
  for (const double value : {1.9e-5, -1.9e-5}) EXPECT_EQ(outcome(gate, value), Outcome::passed) << value;
  for (const double value : {2e-5, 2.1e-5, -2.1e-5})
    EXPECT_EQ(outcome(gate, value), Outcome::failed) << value;
}

TEST(Gate, BetweenBoundsTheSignedValue) {
  const Gate gate = between("order", 1.0, 2.0);
  EXPECT_EQ(outcome(gate, 1.5), Outcome::passed);
  for (const double off : {0.9, 1.0, 2.0, 2.1, -1.5}) EXPECT_EQ(outcome(gate, off), Outcome::failed) << off;
  const Gate negative = between("twist_error", -3e-3, -1e-3);
  EXPECT_EQ(outcome(negative, -2e-3), Outcome::passed);
  for (const double off : {2e-3, 0.0}) EXPECT_EQ(outcome(negative, off), Outcome::failed) << off;
}

TEST(Gate, AboveBoundsTheSignedValue) {
  Gate gate = gate_on("stick_cells");
  gate.bound = Above{3.0};
  EXPECT_EQ(outcome(gate, 4), Outcome::passed);
  for (const double value : {3.0, 2.0, -4.0}) EXPECT_EQ(outcome(gate, value), Outcome::failed) << value;
  EXPECT_DOUBLE_EQ(judge(gate, solve_with("stick_cells", 2)).factor, 1.5);
}

TEST(Gate, EqualsTakesWordsAndCounts) {
  EXPECT_EQ(outcome(equals("verdict", "asymptotic"), "asymptotic"), Outcome::passed);
  EXPECT_EQ(outcome(equals("verdict", "asymptotic"), "preasymptotic"), Outcome::failed);
  EXPECT_EQ(outcome(equals("verdict", "asymptotic"), 1.0), Outcome::failed);
  EXPECT_EQ(outcome(equals("steps", 8.0), 8), Outcome::passed);
  EXPECT_EQ(outcome(equals("steps", 8.0), 9), Outcome::failed);
  EXPECT_EQ(outcome(equals("steps", 8.0), "8"), Outcome::failed);
}

TEST(Gate, FactorSaysHowFarFromTheBound) {
  EXPECT_DOUBLE_EQ(judge(below("x", 2.0), solve_with("x", -3.0)).factor, 1.5);
  EXPECT_DOUBLE_EQ(judge(between("x", 1.0, 2.0), solve_with("x", 0.5)).factor, 2.0);
  EXPECT_DOUBLE_EQ(judge(between("x", 1.0, 2.0), solve_with("x", 1.5)).factor, 0.0);
  EXPECT_TRUE(std::isinf(judge(below("x", 2.0), solve_with("x", nullptr)).factor));
}

TEST(Gate, NoNumberFailsWithTheReasonBesideIt) {
  Json result = solve_with("twist_error", nullptr);
  result["twist_error_reason"] = "not axisymmetric";
  for (const Gate& gate : {below("twist_error", 1.0), equals("twist_error", "asymptotic")}) {
    const Judgement judgement = judge(gate, result);
    EXPECT_EQ(judgement.outcome, Outcome::failed);
    EXPECT_THAT(judgement.why, AllOf(HasSubstr("twist_error"), HasSubstr("not axisymmetric")));
  }
  result["traction_error"] = nullptr;
  result["traction_error_reason"] = "no exact tractions";
  EXPECT_THAT(judge(below("traction_error.averaged.l2", 1.0), result).why, HasSubstr("no exact tractions"));
  result["list"] = {1.0, 2.0};
  EXPECT_EQ(judge(below("list", 3.0), result).outcome, Outcome::failed);
  const double nan = std::nan("");
  for (const Gate& gate : {below("x", 1.0), between("x", -1.0, 1.0)}) {
    EXPECT_EQ(judge(gate, solve_with("x", nan)).outcome, Outcome::failed);
  }
}

TEST(Gate, MissingQuantityFailsAndNamesTheNearest) {
  const Judgement judgement = judge(below("twist_eror", 1.0), solve_with("twist_error", 1e-6));
  EXPECT_EQ(judgement.outcome, Outcome::failed);
  EXPECT_THAT(judgement.why, AllOf(HasSubstr("twist_eror"), HasSubstr("twist_error")));
  const Json failed{{"status", "failed"}, {"message", "killed by signal 9"}};
  EXPECT_THAT(judge(below("twist_error", 1.0), failed).why, HasSubstr("killed by signal 9"));
}

TEST(Gate, SolveThatDidNotConvergeFailsWhateverItsNumber) {
  Json result = solve_with("twist_error", 1e-7);
  result["status"] = "not_converged";
  result["message"] = "out of steps";
  const Judgement judgement = judge(below("twist_error", 1e-5), result);
  EXPECT_EQ(judgement.outcome, Outcome::failed);
  EXPECT_THAT(judgement.why, HasSubstr("out of steps"));
  EXPECT_EQ(judge(equals("status", "not_converged"), result).outcome, Outcome::passed);
}

TEST(Gate, TighterThanTenTimesReferenceAndSpreadIsRefused) {
  Json result = solve_with("twist_error", 1e-9);
  result["exact"]["relative_uncertainty"] = 3e-8;
  Gate gate = below("twist_error", 0.9e-6);
  gate.platform_spread = 5e-8;
  EXPECT_EQ(judge(gate, result).outcome, Outcome::passed);
  gate.platform_spread = 7e-8;
  const Judgement refused = judge(gate, result);
  EXPECT_EQ(refused.outcome, Outcome::refused);
  EXPECT_THAT(refused.why, AllOf(HasSubstr("9e-07"), HasSubstr("1e-06")));
  EXPECT_EQ(exit_code({refused}), 2);
  gate.bound = Between{0.0, 0.9e-6};  // half as wide as Below
  gate.platform_spread = 2e-8;
  EXPECT_EQ(judge(gate, result).outcome, Outcome::refused);
  gate.bound = Between{-0.9e-6, 0.9e-6};
  EXPECT_EQ(judge(gate, result).outcome, Outcome::passed);
}

TEST(Gate, ReferenceCountsForErrorsOnly) {
  Json result{
      {"exact", {{"relative_uncertainty", 1e-3}}}, {"certificate", {{"gap", 1e-9}}}, {"twist_error", 1e-4}};
  EXPECT_EQ(judge(below("certificate.gap", 1e-8), result).outcome, Outcome::passed);
  EXPECT_EQ(judge(below("twist_error", 1e-3), result).outcome, Outcome::refused);
  result.erase("exact");
  const Judgement unknown = judge(below("twist_error", 1e-3), result);
  EXPECT_EQ(unknown.outcome, Outcome::refused);
  EXPECT_FALSE(unknown.why.empty());
}

TEST(Gate, NearestReferenceIsTheOneThatCounts) {
  const Json result{
      {"exact", {{"relative_uncertainty", 1e-2}}},
      {"steps", {{{"exact", {{"relative_uncertainty", 1e-9}}}, {"twist_error", 1e-4}}}},
      {"series",
       {{"nu-0.3", {{"reference_uncertainty", 2e-5}, {"order", {{"twist_error", {{"value", 2.0}}}}}}}}}};
  EXPECT_EQ(reference_error(result, "steps[0].twist_error"), 1e-9);
  EXPECT_EQ(reference_error(result, "series.nu-0.3.order.twist_error.value"), 2e-5);
  EXPECT_EQ(reference_error(result, "iterations"), 0.0);
}

TEST(Gate, OfAResultFileTheReferenceCountsWhereItIsStated) {
  Gate gate = below("counts.errors", 10.0);
  gate.source = ResultSource{.file = "work.json", .folder = {}, .made_by = {}};
  Json result{{"counts", {{"errors", 3}}}};
  EXPECT_EQ(judge(gate, result).outcome, Outcome::passed) << "the file says nothing of a reference";
  result["counts"]["reference_uncertainty"] = 0.9;
  EXPECT_EQ(judge(gate, result).outcome, Outcome::passed);
  result["counts"]["reference_uncertainty"] = 1.1;
  EXPECT_EQ(judge(gate, result).outcome, Outcome::refused);
  gate.source = SceneSource{"scene.toml", {}};
  EXPECT_EQ(judge(gate, {{"counts", {{"errors", 3}}}}).outcome, Outcome::refused);
}

TEST(Gate, BoundTextHasEveryDigitOfTheBound) {
  const auto text = [](const Gate& gate) { return bound_text(refuse(gate, "")); };
  EXPECT_THAT(text(equals("x", 1535605.0)), EndsWith(" 1535605"));
  EXPECT_THAT(text(equals("x", "asymptotic")), HasSubstr("\"asymptotic\""));
  EXPECT_THAT(text(between("x", 1535605.0, 1535607.0)), AllOf(HasSubstr("1535605"), HasSubstr("1535607")));
  EXPECT_THAT(text(below("x", 2e-5)), HasSubstr("2e-05"));
}

// program_gate_test.py holds numbers to those of other results.
TEST(Gate, RelativeFactorIsThePartOfTheAllowedDifference) {
  Gate gate = gate_on("x");
  gate.bound = RelativeTo{"other.json", 0.01};
  EXPECT_NEAR(judge_relative(gate, solve_with("x", -2.03), solve_with("x", -2.0)).factor, 1.5, 1e-9);
}

TEST(Gate, ExpectedFailureMustFail) {
  const Gate gate = with_status(below("x", 1.0), GateStatus::expected_failure);
  EXPECT_EQ(outcome(gate, 2.0), Outcome::failed_as_expected);
  const Judgement passed = judge(gate, solve_with("x", 0.5));
  EXPECT_EQ(passed.outcome, Outcome::passed_unexpectedly);
  EXPECT_THAT(passed.why, HasSubstr("remove"));
  EXPECT_EQ(exit_code({passed}), 1);
  EXPECT_EQ(judge(gate, solve_with("y", 2.0)).outcome, Outcome::failed) << "a misspelt quantity";
}

/// A run that died is no answer of any kind: whatever was expected, it fails.
TEST(Gate, RunsThatDiedFailAGateOfAnyStatus) {
  const Json died{{"status", "failed"}, {"message", "killed by signal 9"}};
  Json study = {{"failed_runs",
                 {{"count", 1}, {"of", 35}, {"first", {{"run", "paper"}, {"message", "memory ran out"}}}}},
                {"x", 0.5}};
  for (const GateStatus status :
       {GateStatus::active, GateStatus::expected_failure, GateStatus::report_only}) {
    Gate gate = with_status(below("x", 1.0), status);
    const Judgement solve = judge(gate, died);
    EXPECT_EQ(solve.outcome, Outcome::failed);
    EXPECT_THAT(solve.why, HasSubstr("killed by signal 9"));
    EXPECT_EQ(exit_code({solve}), 1);
    gate.source = StudySource{"study.toml", {}};
    const Judgement some = judge(gate, study);
    EXPECT_EQ(some.outcome, Outcome::failed);
    EXPECT_THAT(some.why, AllOf(HasSubstr("1 of 35"), HasSubstr("paper"), HasSubstr("memory ran out")));
    EXPECT_EQ(some.value, 0.5);
  }
  study["failed_runs"]["count"] = 0;
  EXPECT_EQ(judge(below("x", 1.0), study).outcome, Outcome::passed);
}

}  // namespace
}  // namespace slipstick::convergence
