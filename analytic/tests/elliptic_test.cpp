#include "analytic/elliptic.hpp"

#include "analytic/references/references.hpp"
#include "analytic/tests/values.hpp"

namespace slipstick::analytic {
namespace {

TEST(CompleteElliptic, AgreesWithReferences) {
  constexpr double kBound = 5 * kEps;
  for (const auto& row : testing::read_references("elliptic_references.csv")) {
    const auto value = complete_elliptic(row.argument("complementary_modulus"));
    EXPECT_LE(testing::relative_error(value.k, row.number("k")), kBound) << row.line;
    EXPECT_LE(testing::relative_error(value.e, row.number("e")), kBound) << row.line;
    EXPECT_LE(testing::relative_error(value.d, row.number("d")), kBound) << row.line;
  }
}

TEST(CompleteElliptic, RefusesOtherArguments) {
  for (const double bad : {0.0, -0.1, 1.0 + 1e-15, std::nan(""), HUGE_VAL})
    EXPECT_THROW(complete_elliptic(bad), std::domain_error) << bad;
}

TEST(Carlson, RefusesWhatHasNoValue) {
  EXPECT_THROW(carlson_rf(-1, 1, 1), std::domain_error);
  EXPECT_THROW(carlson_rd(1, 1, 0), std::domain_error);
  EXPECT_THROW(carlson_rj(0, 1, 1, 0), std::domain_error);
}

TEST(Root, RefusesABracketWithoutASignChange) {
  EXPECT_THROW(gsl::root([](double x) { return x * x + 1; }, 0, 2), std::runtime_error);
}

TEST(Callbacks, PassExceptionsOnThroughGsl) {
  const auto bad = [](double x) -> double {
    if (x > 0.5) throw std::domain_error("not here");
    return x - 0.25;
  };
  EXPECT_THROW(gsl::integral(bad, 0, 1), std::domain_error);
  EXPECT_THROW(gsl::root(bad, 0, 1), std::domain_error);
}

}  // namespace
}  // namespace slipstick::analytic
