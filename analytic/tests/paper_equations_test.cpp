#include "analytic/paper_equations.hpp"

#include <stdexcept>

#include "analytic/tests/values.hpp"
#include "analytic/torsion.hpp"

namespace slipstick::analytic {
namespace {

using namespace paper;

double error_of_eq5(double stick_ratio) {
  return std::abs(eq5_moment(stick_ratio) / from_stick_ratio(stick_ratio).moment - 1);
}

TEST(Equation1, AsPrintedJumpsByHalfPi) {
  for (const double c : {0.1, 0.5, 0.8, 0.95}) {
    const double outside = eq1_printed(c, std::nextafter(c, 1.0));
    EXPECT_NEAR(eq1_printed(c, c) / outside, pi / 2, 1e-12) << c;
  }
}

TEST(Equation1, MendedAgreesWithTheStableForm) {
  for (const double c : {0.1, 0.5, 0.8, 0.95})
    for (const double f : {0.0, 0.1, 0.5, 0.9, 0.999, 1.0, 1.01}) {
      const double r = f * c;
      // Literally evaluated, what is left near the centre is a difference of numbers of size K.
      EXPECT_NEAR(eq1(c, r), traction(from_stick_ratio(c), r), 1e-14) << c << ", " << r;
    }
}

TEST(Equation4, AgreesWithTheStableForm) {
  for (const double c : {0.05, 0.3, 0.6, 0.9}) EXPECT_NEAR(eq4_twist(c) / from_stick_ratio(c).twist, 1, 1e-12) << c;
}

TEST(Equation5, HoldsWhereItKeepsDigits) {
  for (const double c : {0.05, 0.3, 0.6, 0.8}) EXPECT_LT(error_of_eq5(c), 1e-13) << c;
}

TEST(Equation5, LosesAllDigitsAsSlipVanishes) {
  EXPECT_GT(error_of_eq5(0.999), 1e-13);
  EXPECT_LT(error_of_eq5(0.999), 1e-10);
  EXPECT_GT(error_of_eq5(0.999999), 1e-8);
  EXPECT_LT(error_of_eq5(0.999999), 1e-4);
}

TEST(Equation6, IsTheMomentOfSlipEverywhere) {
  EXPECT_DOUBLE_EQ(eq6_moment_limit(), 3 * pi / 16);
  EXPECT_NEAR(eq5_moment(1e-3), eq6_moment_limit(), 1e-9);
}

TEST(Equation7, IsFiniteAtTheLimitWhereTheTwistIsNot) {
  EXPECT_LT(eq7_twist(eq6_moment_limit()), 0.3);
  EXPECT_GT(from_moment_deficit(1e-12).twist, 2.0);
  EXPECT_GT(from_moment_deficit(1e-24).twist, 4.0);
}

TEST(PaperEquations, RefuseWhatLiesOutside) {
  for (const double bad : {0.0, 1.0, -0.5, 1.5, kNan}) {
    EXPECT_THROW(eq1(bad, 0.1), std::domain_error) << bad;
    EXPECT_THROW(eq1_printed(bad, 0.1), std::domain_error) << bad;
    EXPECT_THROW(eq4_twist(bad), std::domain_error) << bad;
    EXPECT_THROW(eq5_moment(bad), std::domain_error) << bad;
  }
  for (const double bad : {-0.1, 1.1, kNan}) {
    EXPECT_THROW(eq1(0.5, bad), std::domain_error) << bad;
    EXPECT_THROW(eq7_twist(bad), std::domain_error) << bad;
  }
}

// ---------------------------------------------------------------- other laws of the twist

double error(double (*twist)(double), double moment_ratio) {
  const auto state = from_moment_ratio(moment_ratio);
  return twist(state.moment) / state.twist - 1;
}

/// By how much a law's error falls when a small moment is halved: 2 to its order.
double error_ratio(double (*twist)(double)) {
  constexpr double kSmall = 1e-3;
  return error(twist, kSmall) / error(twist, kSmall / 2);
}

TEST(Approximations, HoldToTheirOrderInSmallMoments) {
  EXPECT_NEAR(error_ratio(no_slip_twist), 2, 0.01);
  EXPECT_NEAR(no_slip_twist(0.3), 0.3 / from_moment_ratio(0).tangent_stiffness, 1e-17);
  EXPECT_NEAR(error_ratio(small_moment_twist), 4, 0.02);
}

TEST(DiscreteElements, FollowTheirSpringUpToTheCap) {
  for (const double moment : {0.0, 1e-9, 0.3, 0.6}) EXPECT_DOUBLE_EQ(dem_moment(dem_twist(moment)), moment);
  EXPECT_DOUBLE_EQ(dem_twist(dem_moment_limit()), 1.0 / 8);
  for (const double moment : {1e-3, 0.5}) EXPECT_EQ(dem_twist(moment), no_slip_twist(moment));
}

/// The table in paper_equations.hpp, in percent.
TEST(Approximations, AreOffAsTabulated) {
  struct Point {
    double moment_ratio, no_slip, small_moment, eq7, dem_moment;
  };
  for (const auto& point :
       {Point{0.1, -4.5, -0.29, -0.093, 4.7}, {0.5, -25.1, -8.5, -3.4, 33.5}, {0.9, -56.4, -39.1, -23.6, 25.8}}) {
    const double m = point.moment_ratio;
    EXPECT_NEAR(100 * error(no_slip_twist, m), point.no_slip, 0.05) << m;
    EXPECT_NEAR(100 * error(dem_twist, m), point.no_slip, 0.05) << m;
    EXPECT_NEAR(100 * error(small_moment_twist, m), point.small_moment, m < 0.5 ? 0.005 : 0.05) << m;
    EXPECT_NEAR(100 * error(eq7_twist, m), point.eq7, m < 0.5 ? 0.0005 : 0.05) << m;
    const auto state = from_moment_ratio(m);
    EXPECT_NEAR(100 * (dem_moment(state.twist) / state.moment - 1), point.dem_moment, 0.05) << m;
  }
  EXPECT_NEAR(100 * (dem_moment(1.0 / 8) / from_twist(1.0 / 8).moment - 1), 62, 0.5);
}

TEST(Approximations, RefuseWhatLiesOutside) {
  for (const auto& law : approximations())
    for (const double bad : {-1e-300, 0.67, HUGE_VAL, kNan})
      EXPECT_THROW(law.twist(bad), std::domain_error) << law.name << ' ' << bad;
  for (const double beyond : {0.59, 0.66}) {
    EXPECT_THROW(no_slip_twist(beyond), std::domain_error);
    EXPECT_THROW(small_moment_twist(beyond), std::domain_error);
  }
  for (const double bad : {-1e-300, -HUGE_VAL, kNan}) EXPECT_THROW(dem_moment(bad), std::domain_error) << bad;
}

}  // namespace
}  // namespace slipstick::analytic
