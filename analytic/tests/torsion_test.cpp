#include "analytic/torsion.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "analytic/gsl.hpp"
#include "analytic/references/replay.hpp"
#include "analytic/tests/values.hpp"

namespace slipstick::analytic {
namespace {

using std::numbers::pi;
using ::testing::HasSubstr;
using testing::kFrom;
using testing::kMember;
using testing::relative_error;
using ::testing::ThrowsMessage;

/// M/(mu W a) of the tractions: 3 integral_0^1 q/(mu p0) r^2 dr, on either side of the front by the sine of
/// an angle, which makes both square-root ends smooth.
double moment_of_traction(const TorsionState& state) {
  const double c = state.stick_ratio;
  const double stick = gsl::integral(
      [&](double t) {
        return traction(state, c * std::sin(t)) * std::pow(c * std::sin(t), 2) * c * std::cos(t);
      },
      0, pi / 2);
  const double slip = gsl::integral(
      [&](double t) { return traction(state, std::sin(t)) * std::pow(std::sin(t), 2) * std::cos(t); },
      std::asin(c), pi / 2);
  return 3 * (stick + slip);
}

/// Every member from every argument: 1e-14 and what one ulp of the argument costs.
TEST(Torsion, AgreesWithReferences) {
  for (const auto& row : testing::read_references("torsion_references.csv")) {
    const TorsionState state = kFrom.at(row.text("given"))(row.argument("value"), hertz_profile());
    for (const auto& [name, member] : kMember) {
      const double cost = row.argument("cost_" + name);
      EXPECT_LE(relative_error(state.*member, row.number(name)), 1e-14 + cost * kEps)
          << name << " of " << row.line();
    }
  }
}

TEST(Torsion, AgreesWithTabulatedStickRatios) {
  const std::vector<std::pair<double, double>> table{{0.1, 0.9693964204953627},
                                                     {0.5, 0.8135681261276496},
                                                     {0.9, 0.4958950522157781},
                                                     {0.99, 0.2369661925296642}};
  for (const auto& [moment_ratio, stick_ratio] : table) {
    // A ratio of 0.99 is a double off by up to half an ulp, which its deficit of 0.01 feels a hundredfold.
    const double cost = moment_ratio / (1 - moment_ratio) / 3;
    EXPECT_NEAR(from_moment_ratio(moment_ratio).stick_ratio, stick_ratio, (4 + cost) * kEps) << moment_ratio;
  }
}

TEST(Torsion, FollowsTheAsymptotesAtBothEnds) {
  for (const double w : {1e-300, 1e-100, 1e-16}) {
    const auto state = from_stick_complement(w);
    EXPECT_LE(relative_error(state.moment_ratio, 32 * w / (3 * pi)), 8 * kEps) << w;
    EXPECT_LE(relative_error(state.twist, 3 * w / 8), 8 * kEps) << w;
    EXPECT_LE(relative_error(from_moment_ratio(state.moment_ratio).stick_complement, w), 8 * kEps) << w;
    EXPECT_LE(relative_error(from_twist(state.twist).stick_complement, w), 8 * kEps) << w;
  }
  for (const double c : {1e-100, 1e-30, 1e-9}) {
    const auto state = from_stick_ratio(c);
    EXPECT_LE(relative_error(state.moment_deficit, 64 * c * c * c / (9 * pi * pi)), 8 * kEps) << c;
    EXPECT_LE(relative_error(state.twist, 3 / (4 * pi) * (std::log(4 / c) - 1)), 8 * kEps) << c;
    EXPECT_LE(relative_error(from_moment_deficit(state.moment_deficit).stick_ratio, c), 8 * kEps) << c;
  }
}

TEST(Torsion, AtNoLoadSticksEverywhere) {
  for (const auto& state : {from_moment_ratio(0), from_moment_deficit(1), from_stick_ratio(1),
                            from_stick_complement(0), from_twist(0)}) {
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

/// Forth by one argument and back by any other. Each way may cost 1e-14 and an ulp of what was handed over.
TEST(Torsion, GoesRoundBetweenAllArguments) {
  for (const double c : {0.01, 0.2, 0.5, 0.7, 0.71, 0.9, 0.99}) {
    const auto start = from_stick_ratio(c);
    for (const auto& [name, from] : kFrom) {
      const auto back = from(start.*kMember.at(name), hertz_profile());
      // dc/c per relative change of what was handed over: at most that of 1 - deficit, or of 1 - c.
      const double slope = 64 / (3 * pi * pi) * c * c;  // of M/M_lim in c, from below
      const double cost = name == "moment_ratio"     ? start.moment_ratio / (slope * c)
                          : name == "moment_deficit" ? start.moment_deficit / (slope * c)
                          : name == "twist"          ? 4 * pi / 3 * start.twist
                                                     : std::max(1.0, (1 - c) / c);
      EXPECT_NEAR(back.stick_ratio / c, 1, 1e-14 + cost * 4 * kEps) << name << ", c = " << c;
    }
  }
}

/// H grows by pi/4 (1 - c) there, and the twist by that over 4 pi.
TEST(Torsion, KeepsItsDigitsALittleBeyondFullStick) {
  const Profile& punch = flat_punch_profile();
  const double stuck = from_stick_ratio(1, punch).twist;
  for (double beyond = 1e-3; beyond > 1e-13; beyond /= 3) {
    const double twist = stuck + beyond;
    const double exact_beyond = twist - stuck;
    EXPECT_LE(relative_error(from_twist(twist, punch).stick_complement, 16 * exact_beyond),
              1e-13 + 16 * exact_beyond)
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

TEST(Torsion, HasTheMomentOfItsTractions) {
  for (const double c : {0.01, 0.3, 0.5, 0.75, 0.95, 0.999})
    EXPECT_NEAR(moment_of_traction(from_stick_ratio(c)) / from_stick_ratio(c).moment, 1, 1e-13) << c;
}

/// dM/dphi is that of a bonded punch of radius a_s: 16/3 G a_s^3 (moment and twist come from separate
/// formulas).
TEST(Torsion, HasTheTangentStiffnessOfItsStickArea) {
  for (const double c : {0.05, 0.3, 0.6, 0.9, 0.99}) {
    const double h = 1e-4 * c * (1 - c);
    const auto high = from_stick_ratio(c + h);
    const auto low = from_stick_ratio(c - h);
    // M/(mu W a) over G a^2 phi/(mu W) is M/(G a^3 phi).
    const double quotient = (high.moment - low.moment) / (high.twist - low.twist);
    EXPECT_NEAR(quotient / from_stick_ratio(c).tangent_stiffness, 1, 1e-7) << c;
    EXPECT_NEAR(from_stick_ratio(c).tangent_stiffness, 16.0 / 3 * c * c * c, 1e-15) << c;
  }
}

TEST(Torsion, HasTheLimitOfSlipEverywhere) {
  // 3 integral_0^1 sqrt(1 - r^2) r^2 dr
  const double slip =
      3 * gsl::integral([](double t) { return std::pow(std::sin(t) * std::cos(t), 2); }, 0, pi / 2);
  EXPECT_NEAR(hertz_profile().moment_limit() / slip, 1, 1e-14);
}

TEST(Traction, AgreesWithReferences) {
  for (const auto& row : testing::read_references("traction_references.csv")) {
    const TorsionState state = kFrom.at(row.text("given"))(row.argument("value"), hertz_profile());
    EXPECT_LE(relative_error(traction(state, row.argument("radius")), row.number("traction")), 1e-14)
        << row.line();
  }
}

TEST(Traction, IsContinuousAtTheFrontAndCoulombsBeyond) {
  for (const double c : {1e-12, 1e-9, 1e-3, 0.5, 0.9, 0.999999}) {
    const auto state = from_stick_ratio(c);
    const double front = std::sqrt((1 - c) * (1 + c));
    EXPECT_NEAR(traction(state, c) / front, 1, 2 * kEps) << c;
    // Inside, q falls off its value at the front like the square root of the distance.
    const double inside = std::nextafter(c, 0.0);
    EXPECT_NEAR(traction(state, inside) / front, 1, 4 * std::sqrt(1 - inside / c) / front) << c;
    for (const double r : {c, (1 + c) / 2, 1.0})
      EXPECT_NEAR(traction(state, r), std::sqrt((1 - r) * (1 + r)), kEps) << c;
  }
}

TEST(Traction, StaysBelowFrictionInTheStickZone) {
  for (const double c : {1e-6, 0.2, 0.7, 0.99})
    for (const double f : {0.0, 0.1, 0.5, 0.9, 0.999}) {
      const double r = f * c;
      EXPECT_LT(traction(from_stick_ratio(c), r), std::sqrt(1 - r * r)) << c << ", " << f;
    }
}

TEST(Traction, IsLinearAtTheCentre) {
  for (const double c : {1e-6, 0.2, 0.7, 0.99}) {
    const auto state = from_stick_ratio(c);
    EXPECT_EQ(traction(state, 0), 0) << c;
    const double r = 1e-9 * c;
    EXPECT_NEAR(traction(state, 2 * r) / traction(state, r), 2, 8 * kEps) << c;
  }
}

TEST(TorsionRange, NamesGrossSlip) {
  for (const double bad : {1.0, 1.2, HUGE_VAL})
    EXPECT_THAT([&] { from_moment_ratio(bad); }, ThrowsMessage<std::domain_error>(AllOf(
                                                     HasSubstr("gross slip"), HasSubstr("0 <= M/M_lim < 1"))))
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

}  // namespace
}  // namespace slipstick::analytic
