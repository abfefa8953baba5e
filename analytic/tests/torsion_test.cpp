#include "analytic/torsion.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <numbers>
#include <set>
#include <stdexcept>

#include "analytic/references/references.hpp"
#include "analytic/tests/values.hpp"

namespace slipstick::analytic {
namespace {

using namespace ::testing;
using testing::kFrom;
using testing::relative_error;

// Every quantity against proven references.

TEST(Accuracy, HoldsOverTheCertifiedTableAndTheHardestInputs) {
  for (const auto& row : testing::all_references()) {
    const auto [error, allowed] = testing::replay(row);
    EXPECT_LE(error, allowed) << "eps: " << row.line;
  }
}

/// Moment and tangent stiffness are in no file: they are M_lim M/M_lim, and 16/3 c^3.
TEST(Accuracy, HoldsForMomentAndStiffness) {
  const std::map<std::string, long double> limit_over_pi{
      {"hertz", 3.0L / 16}, {"cone", 1.0L / 6}, {"flat_punch", 1.0L / 4}};
  for (const auto& row : testing::all_references()) {
    const std::string& name = row.text("profile");
    const std::string& quantity = row.text("quantity");
    if (!limit_over_pi.contains(name) || (quantity != "moment_ratio" && quantity != "stick_ratio")) continue;
    const TorsionState state = testing::kFrom.at(row.text("given"))(row.argument("value"), *find_profile(name).profile);
    const long double reference = row.number("reference");
    const bool moment = quantity == "moment_ratio";
    const long double limit = limit_over_pi.at(name) * std::numbers::pi_v<long double>;
    const long double stiffness = 16.0L / 3 * reference * reference * reference;
    const double error = moment ? testing::relative_error(state.moment, limit * reference)
                                : testing::relative_error(state.tangent_stiffness, stiffness);
    const double cost = row.argument("cost") * (moment ? 1 : 3);
    EXPECT_LE(error / testing::kEps, std::max(testing::kAllowed, testing::kOfTheCost * cost)) << row.line;
  }
}

/// A reference whose own bound were near what is tested would prove nothing.
TEST(Accuracy, IsFarWiderThanTheReferences) {
  for (const auto& row : testing::all_references())
    EXPECT_LE(row.number("bound"), 1e-3L * testing::kEps * std::abs(row.number("reference"))) << row.line;
}

TEST(Accuracy, IsTestedForEveryQuantityOfEveryProfile) {
  std::set<std::string> seen;
  for (const auto& row : testing::read_references("certified_references.csv"))
    seen.insert(fmt::format("{} {} {}", row.text("profile"), row.text("given"), row.text("quantity")));
  for (const std::string profile : {"hertz", "cone", "flat_punch"}) {
    for (const auto& [given, from] : testing::kFrom)
      for (const auto& [quantity, member] : testing::kMember)
        EXPECT_TRUE(given == quantity || seen.contains(fmt::format("{} {} {}", profile, given, quantity)))
            << profile << ' ' << given << ' ' << quantity;
    EXPECT_TRUE(seen.contains(profile + " stick_ratio traction")) << profile;
  }
}

// ---------------------------------------------------------------- facts

TEST(Torsion, AtNoLoadSticksEverywhere) {
  for (const auto& state :
       {from_moment_ratio(0), from_moment_deficit(1), from_stick_ratio(1), from_stick_complement(0), from_twist(0)}) {
    EXPECT_EQ(state.moment_ratio, 0);
    EXPECT_EQ(state.moment_deficit, 1);
    EXPECT_EQ(state.stick_ratio, 1);
    EXPECT_EQ(state.stick_complement, 0);
    EXPECT_EQ(state.twist, 0);
    EXPECT_EQ(state.moment, 0);
    EXPECT_EQ(state.tangent_stiffness, 16.0 / 3);
    for (const double r : {0.0, 0.5, 1.0}) EXPECT_EQ(traction(state, r), 0) << r;
  }
}

/// H grows by pi/4 (1 - c) there, and the twist by that over 4 pi.
TEST(Torsion, KeepsItsDigitsALittleBeyondFullStick) {
  const Profile& punch = flat_punch_profile();
  const double stuck = from_stick_ratio(1, punch).twist;
  for (double beyond = 1e-3; beyond > 1e-13; beyond /= 3) {
    const double twist = stuck + beyond;
    const double exact_beyond = twist - stuck;
    EXPECT_LE(relative_error(from_twist(twist, punch).stick_complement, 16 * exact_beyond), 1e-13 + 16 * exact_beyond)
        << beyond;
  }
}

TEST(Torsion, CarriesTheArgumentItself) {
  EXPECT_EQ(from_moment_ratio(0.3).moment_ratio, 0.3);
  EXPECT_EQ(from_moment_deficit(1e-12).moment_deficit, 1e-12);
  EXPECT_EQ(from_stick_ratio(0.3).stick_ratio, 0.3);
  EXPECT_EQ(from_stick_complement(1e-20).stick_complement, 1e-20);
  EXPECT_EQ(from_twist(0.3).twist, 0.3);
}

TEST(TorsionRange, NamesGrossSlip) {
  for (const double bad : {1.0, 1.2, HUGE_VAL})
    EXPECT_THAT([&] { from_moment_ratio(bad); },
                ThrowsMessage<std::domain_error>(AllOf(HasSubstr("gross slip"), HasSubstr("0 <= M/M_lim < 1"))))
        << bad;
  EXPECT_THAT([] { from_moment_ratio(1.2); }, ThrowsMessage<std::domain_error>(HasSubstr("1.2")));
  EXPECT_THAT([] { from_moment_deficit(0); }, ThrowsMessage<std::domain_error>(HasSubstr("gross slip")));
}

TEST(TorsionRange, RefusesWhatLiesOutside) {
  for (const double bad : {-1e-300, -1.0, kNan, -HUGE_VAL}) {
    for (const auto& [name, from] : kFrom)
      EXPECT_THROW(from(bad, hertz_profile()), std::domain_error) << name << ' ' << bad;
    EXPECT_THROW(traction(from_stick_ratio(0.5), bad), std::domain_error) << bad;
  }
  EXPECT_THROW(from_moment_deficit(1.1), std::domain_error);
  EXPECT_THROW(from_stick_ratio(0), std::domain_error);
  EXPECT_THROW(from_stick_ratio(1.1), std::domain_error);
  EXPECT_THROW(from_stick_complement(1), std::domain_error);
  EXPECT_THROW(from_twist(HUGE_VAL), std::domain_error);
  EXPECT_THROW(from_twist(200), std::domain_error);
  EXPECT_THROW(traction(from_stick_ratio(0.5), 1.1), std::domain_error);
}

/// Half way to the front of a tiny circle that sticks the traction is (2/pi) arcsin(1/2) of friction.
TEST(TractionsOfTinyStickRadii, DoNotUnderflow) {
  for (const double c : {1e-100, 1e-160, 1e-200, 1e-300}) {
    EXPECT_NEAR(traction(from_stick_ratio(c), c / 2), 1.0 / 3, 1e-15) << c;
  }
  EXPECT_THROW(from_moment_ratio(5e-324), std::domain_error);
}

}  // namespace
}  // namespace slipstick::analytic
