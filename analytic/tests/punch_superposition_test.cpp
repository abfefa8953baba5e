#include "analytic/punch_superposition.hpp"

#include <gmock/gmock.h>

#include "analytic/references/references.hpp"
#include "analytic/tests/values.hpp"
#include "analytic/torsion.hpp"

namespace slipstick::analytic {
namespace {

using namespace ::testing;
using testing::expect_same;
using testing::relative_error;

constexpr double kFewRoundings = 1e-14;

std::vector<std::unique_ptr<const Profile>> profiles() {
  std::vector<std::unique_ptr<const Profile>> all;
  for (const double n : {0.01, 0.5, 1.0, 1.5, 2.0, 4.0, 30.0, 1000.0}) all.push_back(power_profile(n));
  for (const double b : {0.0, 0.001, 0.5, 0.95, 1 - 1e-9}) all.push_back(rounded_punch_profile(b));
  return all;
}

TEST(Superposition, IsTheClosedFormWhereThereIsOne) {
  expect_same(*power_profile(2), hertz_profile(), 1, kFewRoundings);
  expect_same(*power_profile(1), cone_profile(), 1, kFewRoundings);
  expect_same(*rounded_punch_profile(0), hertz_profile(), 1.5, kFewRoundings);
}

TEST(Superposition, AgreesWithReferences) {
  for (const auto& row : testing::read_references("profile_references.csv")) {
    const double parameter = row.argument("parameter");
    const auto profile = row.text("profile") == "power" ? power_profile(parameter) : rounded_punch_profile(parameter);
    const double value = row.argument("value");
    const StickRadius c = row.text("given") == "stick_ratio" ? at(value) : before_edge(value);
    const auto near = [&](double computed, const char* name) {
      EXPECT_LE(relative_error(computed, row.number(name)), kFewRoundings) << name << " of " << row.line;
    };
    near(profile->twist_integral(c), "twist_integral");
    near(profile->twist_slope(c), "twist_slope");
    near(profile->moment_share(c).excess, "moment_ratio");
    near(profile->moment_share(c).deficit, "moment_deficit");
    near(profile->pressure(c.ratio), "pressure");
    const auto traction = [&](double share) {
      const double inward = c.ratio * share;
      return profile->stick_traction(c, c.ratio - inward, inward);
    };
    near(traction(0.99), "traction_centre");
    near(traction(0.1), "traction_middle");
    near(traction(1e-9), "traction_front");
  }
}

TEST(PowerProfile, TellsItsPeak) {
  for (const double n : {0.01, 0.7, 1.0})
    EXPECT_EQ(power_profile(n)->pressure(0), std::numeric_limits<double>::infinity()) << n;
  for (const double n : {1.01, 2.0, 4.0, 1000.0}) {
    EXPECT_NEAR(power_profile(n)->pressure(0) * (n - 1), 1, kFewRoundings) << n;
    EXPECT_NEAR(power_profile(n)->pressure(1e-300) * (n - 1), 1, n < 2 ? 2e-3 : kFewRoundings) << n;
  }
}

/// 1 - M/M_lim ~ c^3 for a finite pressure p(0), by (8/3) integral_0^c s^3 (-H') ds with -s H' -> p(0); under
/// a cone with a logarithm; c^(n+2) under a sharper point.
TEST(Superposition, ReachesTheLimitByItsLaw) {
  for (const auto& profile : profiles()) {
    const double peak = profile->pressure(0);
    if (std::isinf(peak)) continue;
    const double c = 1e-40;
    const double law = 8.0 / 9 * c * c * c * peak / (profile->moment_limit() * profile->load());
    EXPECT_NEAR(profile->moment_share(at(c)).deficit / law, 1, profile->name() == "power:1.5" ? 1e-11 : kFewRoundings)
        << profile->name();
  }
  for (const double n : {0.01, 0.5}) {
    const auto deficit = [&](double c) { return power_profile(n)->moment_share(at(c)).deficit; };
    EXPECT_NEAR(deficit(2e-40) / deficit(1e-40) / std::pow(2, n + 2), 1, 1e-13) << n;
  }
}

TEST(Superposition, LeavesFullStickLinearly) {
  for (const auto& profile : profiles()) {
    const auto ratio = [&](double w) { return profile->moment_share(before_edge(w)).excess; };
    EXPECT_NEAR(ratio(2e-40) / ratio(1e-40), 2, 1e-13) << profile->name();
    EXPECT_EQ(ratio(0), 0) << profile->name();
    EXPECT_EQ(profile->twist_integral(before_edge(0)), 0) << profile->name();
    EXPECT_EQ(profile->moment_share(before_edge(0)).deficit, 1) << profile->name();
    EXPECT_EQ(profile->pressure(1), 0) << profile->name();
  }
}

/// H grows down to the smallest stick radius, like ln(1/c) or faster, and a twist finds its state.
TEST(PowerProfile, AnswersATwistForEveryExponent) {
  for (int i = 0; i <= 1000; ++i) {
    const double n = 0.01 * std::pow(1e5, i / 1000.0);
    const auto profile = power_profile(n);
    EXPECT_GT(profile->twist_integral(at(1e-307)), profile->twist_integral(at(1e-100))) << n;
    EXPECT_GT(from_twist(0.1, *profile).stick_ratio, 0.5) << n;
  }
}

TEST(Superposition, RefusesWhatLiesOutside) {
  for (const double bad : {0.0, -1.0, 1e-3, 1001.0, HUGE_VAL, std::nan("")})
    EXPECT_THROW(power_profile(bad), std::domain_error) << bad;
  for (const double bad : {-1e-9, 1.0, 2.0, HUGE_VAL, std::nan("")})
    EXPECT_THROW(rounded_punch_profile(bad), std::domain_error) << bad;
  EXPECT_THAT([] { power_profile(-3); },
              ThrowsMessage<std::domain_error>(AllOf(HasSubstr("-3"), HasSubstr("0.01 <= n <= 1000"))));
  EXPECT_THAT([] { rounded_punch_profile(1.5); },
              ThrowsMessage<std::domain_error>(AllOf(HasSubstr("1.5"), HasSubstr("0 <= b/a < 1"))));
}

}  // namespace
}  // namespace slipstick::analytic
