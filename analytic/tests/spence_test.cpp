#include "analytic/spence.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

#include "analytic/tests/values.hpp"

namespace slipstick::analytic {
namespace {

using namespace ::testing;

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
  // The ring that slips is narrow, and its deficit is of the order of its width times that share.
  EXPECT_LT(1 - contact.stick_ratio, 2e-5);
  EXPECT_NEAR(contact.stiffness_ratio / stuck, 1, 2e-5);
  EXPECT_LT(contact.stiffness_ratio, stuck);
}

TEST(SpenceRange, RefusesWhatLiesOutside) {
  for (const auto function : {+[](double friction, double beta) { goodman_stick_radius(friction, beta); },
                              +[](double friction, double beta) { spence_contact(friction, beta); }}) {
    for (const double bad : {0.0, -0.1, kInfinity, kNan}) EXPECT_THROW(function(bad, 0.3), std::domain_error) << bad;
    for (const double bad : {0.0, 0.6, -0.6, kNan}) EXPECT_THROW(function(0.3, bad), std::domain_error) << bad;
    EXPECT_THROW(function(1e-4, 0.3), std::domain_error);
    EXPECT_THROW(function(70, 0.3), std::domain_error);
  }
  EXPECT_THAT([] { spence_contact(0.01, 0.5); },
              ThrowsMessage<std::domain_error>(AllOf(HasSubstr("friction/|beta| = 0.02"), HasSubstr("10"))));
}

}  // namespace
}  // namespace slipstick::analytic
