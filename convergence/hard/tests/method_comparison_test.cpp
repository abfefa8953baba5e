#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "convergence/hard/hard_judgement.hpp"

namespace slipstick::convergence {
namespace {

Json answer_of(const char* method, double twist) {
  return {
      {"status", "converged"},
      {"method", method},
      {"tolerance", 1e-8},
      {"twist_angle", twist},
      {"moment", 0.02},
      {"moment_limit", 0.03},
      {"contact_radius", 5e-4},
      {"slip_direction", {{"mean", 1e-4}, {"max", 1e-3}}},
      {"resolved", {{"uncertainty", 0.02}}},
      {"certificate",
       {{"gap", 1e-9}, {"rounding", 1e-14}, {"moment", 1e-15}, {"force", 0.0}, {"friction_bound", -1.0}}}};
}

MethodVerdict beside(const Json& other) {
  const ComparedAnswer compared = compare_answer(answer_of("coulomb", 1e-3), other);
  EXPECT_EQ(compared.reason.empty(), compared.verdict == MethodVerdict::agrees);
  return compared.verdict;
}

TEST(MethodComparison, AgreesWithinOnePercent) {
  for (const double off : {0.0, 0.009, -0.009}) {
    EXPECT_EQ(beside(answer_of("paper", (1.0 + off) * 1e-3)), MethodVerdict::agrees) << off;
  }
  for (const double off : {0.011, -0.011, -2.0}) {
    EXPECT_EQ(beside(answer_of("paper", (1.0 + off) * 1e-3)), MethodVerdict::other_answer) << off;
  }
  Json nothing = answer_of("paper", 1e-3);
  nothing["twist_angle"] = nullptr;
  EXPECT_EQ(beside(nothing), MethodVerdict::other_answer);
}

// Slip that is turned counts where it costs energy: where everything sticks, what slips is rounding.
TEST(MethodComparison, SeesSlipThatDoesNotOpposeTraction) {
  Json turned = answer_of("paper", 1e-3);
  turned["certificate"]["gap"] = 1e-4;
  EXPECT_EQ(beside(turned), MethodVerdict::agrees);
  turned["slip_direction"]["mean"] = 1.1;
  EXPECT_EQ(beside(turned), MethodVerdict::other_direction);
  turned["certificate"]["gap"] = 1e-9;
  EXPECT_EQ(beside(turned), MethodVerdict::agrees);
  turned["certificate"]["gap"] = nullptr;
  EXPECT_EQ(beside(turned), MethodVerdict::other_direction);
}

TEST(MethodComparison, KeepsWhatTheMethodSaysItself) {
  EXPECT_EQ(beside({{"status", "refused"}, {"message", "this method knows torsion alone"}}),
            MethodVerdict::refused);
  EXPECT_EQ(beside({{"status", "not_converged"}, {"message", "every cell slips"}}),
            MethodVerdict::not_converged);
  EXPECT_EQ(beside({{"status", "failed"}, {"message", "signal 11"}}), MethodVerdict::other_answer);
  Json broken = answer_of("paper", 1e-3);
  broken["certificate"]["moment"] = 0.1;
  EXPECT_EQ(beside(broken), MethodVerdict::other_answer);
}

TEST(MethodComparison, BelievesNothingWithoutACertifiedAnswer) {
  const Json refused{{"status", "refused"}, {"message", "beyond the limit"}};
  EXPECT_EQ(compare_answer(refused, answer_of("paper", 1e-3)).verdict, MethodVerdict::other_answer);
  EXPECT_EQ(compare_answer(refused, refused).verdict, MethodVerdict::refused);
}

}  // namespace
}  // namespace slipstick::convergence
