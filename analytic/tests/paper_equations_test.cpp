#include "analytic/paper_equations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "analytic/gsl.hpp"
#include "analytic/torsion.hpp"

namespace slipstick::analytic::paper {
namespace {

using std::numbers::pi;

/// M/(mu W a) of an Eq. (1): 3 integral_0^1 q r^2 dr, stick and slip by the sine of an angle.
double moment_of(const std::function<double(double, double)>& eq1, double c) {
  const auto integrand = [&](double r, double dr) { return eq1(c, r) * r * r * dr; };
  const double stick =
      gsl::integral([&](double t) { return integrand(c * std::sin(t), c * std::cos(t)); }, 0, pi / 2);
  const double slip = gsl::integral([&](double t) { return integrand(std::sin(t), std::cos(t)); },
                                    std::asin(c) + 1e-15, pi / 2);
  return 3 * (stick + slip);
}

double error_of_eq5(double stick_ratio) {
  return std::abs(eq5_moment(stick_ratio) / from_stick_ratio(stick_ratio).moment - 1);
}

TEST(Equation1, MendedIsContinuousAtTheStickRadius) {
  for (const double c : {0.1, 0.5, 0.8, 0.95}) EXPECT_NEAR(eq1(c, c), std::sqrt(1 - c * c), 1e-13) << c;
}

TEST(Equation1, AsPrintedJumpsByHalfPi) {
  for (const double c : {0.1, 0.5, 0.8, 0.95}) {
    const double outside = eq1_printed(c, std::nextafter(c, 1.0));
    EXPECT_NEAR(eq1_printed(c, c) / outside, pi / 2, 1e-12) << c;
  }
}

TEST(Equation1, MendedIntegratesToEquation5) {
  for (const double c : {0.1, 0.3, 0.5, 0.8, 0.9})
    EXPECT_NEAR(moment_of(eq1, c) / eq5_moment(c), 1, 1e-13) << c;
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
  for (const double c : {0.05, 0.3, 0.6, 0.9})
    EXPECT_NEAR(eq4_twist(c) / from_stick_ratio(c).twist, 1, 1e-12) << c;
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
  for (const double bad : {0.0, 1.0, -0.5, 1.5, std::nan("")}) {
    EXPECT_THROW(eq1(bad, 0.1), std::domain_error) << bad;
    EXPECT_THROW(eq1_printed(bad, 0.1), std::domain_error) << bad;
    EXPECT_THROW(eq4_twist(bad), std::domain_error) << bad;
    EXPECT_THROW(eq5_moment(bad), std::domain_error) << bad;
  }
  for (const double bad : {-0.1, 1.1, std::nan("")}) {
    EXPECT_THROW(eq1(0.5, bad), std::domain_error) << bad;
    EXPECT_THROW(eq7_twist(bad), std::domain_error) << bad;
  }
}

}  // namespace
}  // namespace slipstick::analytic::paper
