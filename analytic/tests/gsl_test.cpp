#include "analytic/gsl.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace slipstick::analytic::gsl {
namespace {

TEST(Root, FindsASignChangeToTheLastDigits) {
  EXPECT_NEAR(root([](double x) { return x * x - 2; }, 0, 2), std::numbers::sqrt2, 1e-15);
}

TEST(Root, RefusesABracketWithoutASignChange) {
  EXPECT_THROW(root([](double x) { return x * x + 1; }, 0, 2), std::runtime_error);
}

TEST(Integral, IsExactToRounding) {
  EXPECT_NEAR(integral([](double x) { return std::exp(x); }, 0, 1), std::numbers::e - 1, 1e-14);
}

TEST(Callbacks, PassExceptionsOnThroughGsl) {
  const auto bad = [](double x) -> double {
    if (x > 0.5) throw std::domain_error("not here");
    return x - 0.25;
  };
  EXPECT_THROW(integral(bad, 0, 1), std::domain_error);
  EXPECT_THROW(root(bad, 0, 1), std::domain_error);
}

}  // namespace
}  // namespace slipstick::analytic::gsl
