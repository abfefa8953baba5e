#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <tuple>

#include "convergence/hard/hard_case.hpp"

namespace slipstick::convergence {
namespace {

using namespace testing;

SolveRecord made_record(double error, double uncertainty, double gap = 1e-9) {
  SolveRecord record;
  record.status = RunStatus::converged;
  record.problem.method = "coulomb";
  record.problem.tolerance = 1e-8;
  record.end.errors.twist = {error};
  record.end.resolution.uncertainty = {uncertainty};
  record.end.certificate = {
      .gap = {gap}, .rounding = {1e-14}, .moment = {1e-15}, .force = {0.0}, .friction_bound = {-1.0}};
  return record;
}

SolveRecord without_answer(RunStatus status, const std::string& message) {
  SolveRecord record;
  record.status = status;
  record.message = message;
  return record;
}

TEST(HardJudgement, BelievesAnAnswerWithinItsUncertainty) {
  for (const double sign : {1.0, -1.0}) {
    EXPECT_EQ(judge_alone(made_record(sign * 0.009, 0.01)).verdict, HardVerdict::certified);
    const JudgedCase judged = judge_alone(made_record(sign * 0.011, 0.01));
    EXPECT_EQ(judged.verdict, HardVerdict::wrong);
    EXPECT_THAT(judged.reason, AllOf(HasSubstr("0.011"), HasSubstr("0.01")));
  }
  SolveRecord record = made_record(3.0, 0.01);  // an infinite uncertainty has a reason
  record.end.resolution.uncertainty = {.why_missing = "the stick area lies within a cell"};
  EXPECT_EQ(judge_alone(record).verdict, HardVerdict::certified);
  record.end.resolution.uncertainty = {};
  EXPECT_EQ(judge_alone(record).verdict, HardVerdict::wrong);
}

// A gap of the rounding is the smallest that can be computed; where that is unknown, only the tolerance counts.
TEST(HardJudgement, HoldsACertificateToItsPromise) {
  const auto with = [](Number CertificateRecord::*member, const Number& value, double gap = 1e-9) {
    SolveRecord record = made_record(0.0, 0.01, gap);
    record.end.certificate.*member = value;
    return judge_alone(record).verdict;
  };
  EXPECT_EQ(with(&CertificateRecord::rounding, {3e-8}, 2e-8), HardVerdict::certified);
  EXPECT_EQ(with(&CertificateRecord::rounding, {}, 2e-8), HardVerdict::wrong);
  EXPECT_EQ(judge_alone(made_record(0.0, 0.01, 2e-8)).verdict, HardVerdict::wrong);
  for (const auto member : {&CertificateRecord::gap, &CertificateRecord::moment, &CertificateRecord::force,
                            &CertificateRecord::friction_bound}) {
    for (const Number& bad : {Number{1e-6}, Number{}}) EXPECT_EQ(with(member, bad), HardVerdict::wrong);
  }
}

TEST(HardJudgement, DistinguishesRefusedNotConvergedAndFailed) {
  for (const auto& [status, message, verdict] :
       {std::tuple{RunStatus::refused, "beyond the limit", HardVerdict::refused},
        {RunStatus::refused, "", HardVerdict::wrong},
        {RunStatus::failed, "signal 9", HardVerdict::wrong},
        {RunStatus::not_converged, "rounding", HardVerdict::not_converged}}) {
    EXPECT_EQ(judge_alone(without_answer(status, message)).verdict, verdict) << message;
  }
}

TEST(HardJudgement, HoldsAnAnswerToThoseOnFinerMeshes) {
  // A value of second order, 10 % off: the finer meshes are 2.5 and 0.625 % off.
  EXPECT_TRUE(judge_by_finer(1.1, 0.11, 1.025, 1.00625).holds);
  EXPECT_NEAR(judge_by_finer(1.1, 0.1, 1.025, 1.00625).error, 0.09375 / 1.00625, 1e-15);
  EXPECT_FALSE(judge_by_finer(1.1, 0.05, 1.025, 1.00625).holds);
  EXPECT_FALSE(judge_by_finer(0.9, 0.045, 0.975, 0.99375).holds);
  EXPECT_TRUE(judge_by_finer(-1.1, 0.11, -1.025, -1.00625).holds);
  EXPECT_TRUE(judge_by_finer(5.0, 5.0, 1.2, 1.1).holds);  // off by its own size, it says
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(judge_by_finer(1.0, 0.1, nan, 1.0).holds);
  for (const double uncertainty : {0.1, 5.0}) {
    EXPECT_FALSE(judge_by_finer(1.0, uncertainty, 1.0, nan).holds);
    EXPECT_FALSE(judge_by_finer(nan, uncertainty, 1.0, 1.0).holds);
  }
}

TEST(HardJudgement, TakesTheNumberThatIsUncertain) {
  SolveRecord record;
  record.end.loads.twist_angle = {-2e-3};
  record.end.loads.displacement.values = {3e-6, 4e-6};
  record.end.loads.force.values = {0.0, 0.0};
  const auto value_of = [&](const char* number) {
    record.end.resolution.number = number;
    return main_value(record);
  };
  EXPECT_EQ(value_of("twist_angle"), -2e-3);
  EXPECT_DOUBLE_EQ(value_of("displacement"), 5e-6);
  EXPECT_TRUE(std::isnan(value_of("force")));   // zero: no relative error
  EXPECT_TRUE(std::isnan(value_of("moment")));  // missing
  record.end.resolution.absolute = {0.0};       // no load acts: the motion is rounding
  EXPECT_TRUE(std::isnan(value_of("twist_angle")));
}

// 1e-6 far from the limit; where 1e-5 of the load is missing to it, also the tolerance 1e-8 over that.
TEST(HardJudgement, AllowsLargerDifferencesNearTheLimit) {
  const auto allowed = [](double factor) {
    SolveRecord record;
    record.problem.tolerance = 1e-8;
    record.end.loads.limit.factor = {factor};
    return same_answer(record);
  };
  EXPECT_NEAR(allowed(2.0), 1.01e-6, 1e-12);
  EXPECT_NEAR(allowed(1.0 + 1e-5), 1e-3 + 1e-6, 1e-9);
  EXPECT_EQ(allowed(Number().value), 1e-6);
}

void set_loads(SolveRecord& record, double twist, double moment, double limit, double radius) {
  record.end.loads.twist_angle = {twist};
  record.end.loads.moment = {moment};
  record.end.loads.moment_limit = {limit};
  record.end.contact.contact_radius = {radius};
}

TEST(HardJudgement, ComparesSignsAndUnits) {
  SolveRecord first;
  set_loads(first, 1e-3, 0.02, 0.03, 5e-4);
  SolveRecord seen = first;
  EXPECT_EQ(variant_difference(first, seen, Variant::turned), 0.0);
  EXPECT_EQ(variant_difference(first, seen, Variant::mirrored), 2.0);
  set_loads(seen, -1e-3, -0.02, 0.03, 5e-4);
  EXPECT_EQ(variant_difference(first, seen, Variant::mirrored), 0.0);
  set_loads(seen, 1e-3, 20.0, 30.0, 0.5);
  EXPECT_LE(variant_difference(first, seen, Variant::in_other_units), 1e-15);
  seen.end.loads.moment = {};
  EXPECT_TRUE(std::isnan(variant_difference(first, seen, Variant::in_other_units)));
}

SolveRecord answer_of(const char* method, double twist) {
  SolveRecord answer = made_record(0.0, 0.02);
  answer.problem.method = method;
  set_loads(answer, twist, 0.02, 0.03, 5e-4);
  answer.method.slip_direction = {.mean = {1e-4}, .max = {1e-3}};
  return answer;
}

MethodVerdict verdict_on(const SolveRecord& other) {
  const ComparedAnswer compared = compare_answer(answer_of("coulomb", 1e-3), other);
  EXPECT_EQ(compared.reason.empty(), compared.verdict == MethodVerdict::agrees);
  return compared.verdict;
}

TEST(MethodComparison, AgreesWithinOnePercent) {
  for (const double off : {0.0, 0.009, -0.009}) {
    EXPECT_EQ(verdict_on(answer_of("paper", (1.0 + off) * 1e-3)), MethodVerdict::agrees) << off;
  }
  for (const double off : {0.011, -0.011, -2.0}) {
    EXPECT_EQ(verdict_on(answer_of("paper", (1.0 + off) * 1e-3)), MethodVerdict::other_answer) << off;
  }
  EXPECT_EQ(verdict_on(answer_of("paper", Number().value)), MethodVerdict::other_answer);
}

// Turned slip counts where it costs energy; where everything sticks, the slip is rounding.
TEST(MethodComparison, FindsSlipThatDoesNotOpposeTraction) {
  SolveRecord turned = answer_of("paper", 1e-3);
  turned.end.certificate.gap = {1e-4};
  EXPECT_EQ(verdict_on(turned), MethodVerdict::agrees);
  turned.method.slip_direction.mean = {1.1};
  EXPECT_EQ(verdict_on(turned), MethodVerdict::other_direction);
  turned.end.certificate.gap = {1e-9};
  EXPECT_EQ(verdict_on(turned), MethodVerdict::agrees);
  turned.end.certificate.gap = {};
  EXPECT_EQ(verdict_on(turned), MethodVerdict::other_direction);
}

TEST(MethodComparison, KeepsTheMethodsOwnStatus) {
  EXPECT_EQ(verdict_on(without_answer(RunStatus::refused, "only torsion")), MethodVerdict::refused);
  EXPECT_EQ(verdict_on(without_answer(RunStatus::not_converged, "all slips")), MethodVerdict::not_converged);
  EXPECT_EQ(verdict_on(without_answer(RunStatus::failed, "signal 11")), MethodVerdict::other_answer);
  SolveRecord broken = answer_of("paper", 1e-3);
  broken.end.certificate.moment = {0.1};
  EXPECT_EQ(verdict_on(broken), MethodVerdict::other_answer);
}

TEST(MethodComparison, AgreesWithNothingWithoutACertifiedAnswer) {
  const SolveRecord refused = without_answer(RunStatus::refused, "beyond the limit");
  EXPECT_EQ(compare_answer(refused, answer_of("paper", 1e-3)).verdict, MethodVerdict::other_answer);
  EXPECT_EQ(compare_answer(refused, refused).verdict, MethodVerdict::refused);
}

}  // namespace
}  // namespace slipstick::convergence
