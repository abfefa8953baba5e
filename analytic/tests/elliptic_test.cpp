#include "analytic/elliptic.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "analytic/references/references.hpp"
#include "analytic/tests/values.hpp"

namespace slipstick::analytic {
namespace {

using std::numbers::pi;

TEST(CompleteElliptic, AgreesWithReferences) {
  constexpr double kBound = 5 * kEps;
  for (const auto& row : testing::read_references("elliptic_references.csv")) {
    const auto value = complete_elliptic(row.argument("complementary_modulus"));
    EXPECT_LE(testing::relative_error(value.k, row.number("k")), kBound) << row.line();
    EXPECT_LE(testing::relative_error(value.e, row.number("e")), kBound) << row.line();
    EXPECT_LE(testing::relative_error(value.d, row.number("d")), kBound) << row.line();
    EXPECT_LE(
        testing::relative_error(complete_elliptic_k(row.argument("complementary_modulus")), row.number("k")),
        kBound)
        << row.line();
  }
}

TEST(CompleteElliptic, SatisfiesLegendresRelation) {
  for (const double angle : {0.01, 0.2, 0.5, pi / 4, 1.0, 1.5}) {
    const auto [k1, e1, d1] = complete_elliptic(std::sin(angle));
    const auto [k2, e2, d2] = complete_elliptic(std::cos(angle));
    EXPECT_NEAR(e1 * k2 + e2 * k1 - k1 * k2, pi / 2, 20 * kEps) << angle;
  }
}

TEST(CompleteElliptic, IsElementaryAtModulusZero) {
  const auto value = complete_elliptic(1);
  EXPECT_NEAR(value.k, pi / 2, 2 * kEps);
  EXPECT_NEAR(value.e, pi / 2, 2 * kEps);
  EXPECT_NEAR(value.d, pi / 4, 2 * kEps);
}

TEST(CompleteElliptic, RefusesOtherArguments) {
  for (const double bad : {0.0, -0.1, 1.0 + 1e-15, std::nan(""), HUGE_VAL})
    EXPECT_THROW(complete_elliptic(bad), std::domain_error) << bad;
  EXPECT_THROW(complete_elliptic_k(0), std::domain_error);
}

TEST(Carlson, HasKnownSpecialValues) {  // DLMF 19.20
  EXPECT_NEAR(carlson_rf(2, 2, 2), 1 / std::sqrt(2), 2 * kEps);
  EXPECT_NEAR(carlson_rd(2, 2, 2), std::pow(2, -1.5), 2 * kEps);
  EXPECT_NEAR(carlson_rj(2, 2, 2, 2), std::pow(2, -1.5), 2 * kEps);
  EXPECT_NEAR(carlson_rj(1, 2, 3, 3), carlson_rd(1, 2, 3), 2 * kEps);
}

TEST(Carlson, RefusesWhatHasNoValue) {
  EXPECT_THROW(carlson_rf(-1, 1, 1), std::domain_error);
  EXPECT_THROW(carlson_rd(1, 1, 0), std::domain_error);
  EXPECT_THROW(carlson_rj(0, 1, 1, 0), std::domain_error);
}

}  // namespace
}  // namespace slipstick::analytic
