#include "analytic/spence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "analytic/elliptic.hpp"
#include "analytic/gsl.hpp"
#include "analytic/tests/values.hpp"

namespace slipstick::analytic {
namespace {

using std::numbers::pi;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// Radial displacement of Goodman's traction under a sphere over the combined compliance, ring by ring:
/// integral q(s) s integral J_1(kr) J_1(ks) dk ds, the inner one (2/pi) (K - E)/(k max(r, s)), k = min/max.
double radial_displacement(double friction, double beta, double r) {
  const auto ring = [&](double s) {
    if (s == 0 || s == r || s == 1) return 0.0;
    const double k = std::min(r, s) / std::max(r, s);
    const double d = complete_elliptic(std::sqrt((1 - k) * (1 + k))).d;  // (K - E)/k^2
    return goodman_sphere_traction(friction, beta, s) * s * 2 / pi * k * d / std::max(r, s);
  };
  std::vector<double> ends{0, goodman_stick_radius(friction, beta).ratio, r, 1};
  std::sort(ends.begin(), ends.end());
  const gsl::GaussRule rule(64);
  double sum = 0;
  for (std::size_t i = 1; i < ends.size(); ++i) {
    const double span = ends[i] - ends[i - 1];
    sum += rule(
        [&](double t) {
          return ring(ends[i - 1] + span * std::pow(std::sin(t), 2)) * span * std::sin(2 * t);
        },
        0, pi / 2);
  }
  return sum;
}

TEST(GoodmanContact, HoldsTheStickAreaAndLetsTheRingSlipInwards) {
  // Relative displacement, with the pressure's -beta (1/r) integral_0^r p s ds. As the contact grows it is
  // a^2 times a function of r/a; where a point sticks it does not depend on a, and so is like r^2.
  const double beta = 0.3;
  const double friction = 0.15;
  const double c = goodman_stick_radius(friction, beta).ratio;
  const auto over_square = [&](double r) {
    const double by_pressure = beta * (1 - std::pow((1 - r) * (1 + r), 1.5)) / (3 * r);
    return (radial_displacement(friction, beta, r) - by_pressure) / (r * r);
  };
  const double stuck = over_square(0.5 * c);
  EXPECT_LT(stuck, 0);
  for (const double share : {0.3, 0.7, 0.95})
    EXPECT_NEAR(over_square(share * c) / stuck, 1, 1e-6) << share;  // the rings' logarithms cost the rest
  // It moves inwards in the ring while a grows: d/da (a^2 U(r/a)) < 0, where U = r^2 over_square.
  double before = stuck;
  for (const double share : {0.3, 0.6, 0.9}) {
    const double next = over_square(std::lerp(c, 1, share));
    EXPECT_GT(next, before) << share;
    before = next;
  }
}

TEST(GoodmanContact, StaysWithinCoulombsBoundAndMeetsItAtTheFront) {
  const double c = goodman_stick_radius(0.2, 0.3).ratio;
  const auto share = [](double r) {
    return goodman_sphere_traction(0.2, 0.3, r) / hertz_profile().pressure(r);
  };
  EXPECT_EQ(share(0), 0);
  for (const double r : {0.01, 0.3, 0.6, 0.9, 0.999}) EXPECT_LT(share(r * c), 0.2) << r;
  EXPECT_NEAR(share(c * (1 - 1e-8)), 0.2, 1e-4);  // like a square root
  EXPECT_NEAR(share((1 + c) / 2), 0.2, 1e-15);
}

TEST(GoodmanContact, HoldsItsDigitsAtBothEnds) {
  // c -> 0: 1 = (mu/beta) (ln(4/c) + O(c^2)); c -> 1: (1/2) ln(2/(1 - c)) = (mu/beta) pi/2 + O(1 - c).
  for (const double ratio : {1.0 / 20, 1.0 / 300}) {
    const double c = goodman_stick_radius(0.1 * ratio, 0.1).ratio;
    EXPECT_NEAR(c / (4 * std::exp(-1 / ratio)), 1, 1e-11);
  }
  for (const double ratio : {15.0, 100.0}) {
    const double complement = goodman_stick_radius(0.1 * ratio, 0.1).complement;
    EXPECT_NEAR(complement / (2 * std::exp(-pi * ratio)), 1, 1e-11);
  }
}

TEST(GoodmanContact, KnowsOnlyTheRatioAndNoSign) {
  EXPECT_EQ(goodman_stick_radius(0.1, -0.3).ratio, goodman_stick_radius(0.1, 0.3).ratio);
  EXPECT_NEAR(goodman_stick_radius(0.1, 0.3).ratio, goodman_stick_radius(0.01, 0.03).ratio, 1e-14);
  EXPECT_LT(goodman_stick_radius(0.1, 0.3).ratio, goodman_stick_radius(0.11, 0.3).ratio);
}

TEST(SpenceContact, SticksInHalfTheRadiusWhereSpenceSays) {
  // A rigid body on one with nu = 0 (Spence 1975, as in Kalker's CONTACT: mu = 0.2986, four digits).
  const auto contact = spence_contact(0.2986, -0.5);
  EXPECT_NEAR(contact.stick_ratio, 0.5, 5e-4);
  EXPECT_LT(contact.stick_error, 1e-8);
  EXPECT_LT(contact.stick_ratio, goodman_stick_radius(0.2986, 0.5).ratio);
  EXPECT_GT(contact.stiffness_ratio, 1);
  EXPECT_LT(contact.stiffness_ratio, std::atanh(0.5) / 0.5);
}

TEST(SpenceContact, TendsToGoodmansWithTheSquareOfBeta) {
  const auto difference = [](double beta) {
    const auto contact = spence_contact(beta / 2, beta);
    return goodman_stick_radius(beta / 2, beta).ratio - contact.stick_ratio;
  };
  const double large = difference(0.02);
  EXPECT_GT(large, 0);
  EXPECT_LT(large, 0.02 * 0.02);
  EXPECT_NEAR(large / difference(0.01), 4, 1e-2);  // beta^4 comes next
}

TEST(SpenceContact, IsAsStiffAsMossakovskiiSaysWhereFrictionIsLarge) {
  const double stuck = std::atanh(0.3) / 0.3;
  const auto contact = spence_contact(3, 0.3);
  // The ring that slips is narrow, and what it lacks is of the order of its width times that share.
  EXPECT_LT(1 - contact.stick_ratio, 2e-5);
  EXPECT_NEAR(contact.stiffness_ratio / stuck, 1, 2e-5);
  EXPECT_LT(contact.stiffness_ratio, stuck);
}

TEST(SpenceRange, RefusesWhatLiesOutside) {
  for (const auto function : {+[](double friction, double beta) { goodman_stick_radius(friction, beta); },
                              +[](double friction, double beta) { spence_contact(friction, beta); }}) {
    for (const double bad : {0.0, -0.1, kInfinity, kNan})
      EXPECT_THROW(function(bad, 0.3), std::domain_error) << bad;
    for (const double bad : {0.0, 0.6, -0.6, kNan})
      EXPECT_THROW(function(0.3, bad), std::domain_error) << bad;
    EXPECT_THROW(function(1e-4, 0.3), std::domain_error);
    EXPECT_THROW(function(70, 0.3), std::domain_error);
  }
  for (const double bad : {-0.1, 1.1, kNan})
    EXPECT_THROW(goodman_sphere_traction(0.2, 0.3, bad), std::domain_error) << bad;
  EXPECT_THAT([] { spence_contact(0.01, 0.5); },
              ThrowsMessage<std::domain_error>(AllOf(HasSubstr("friction/|beta| = 0.02"), HasSubstr("10"))));
}

}  // namespace
}  // namespace slipstick::analytic
