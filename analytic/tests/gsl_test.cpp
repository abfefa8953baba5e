#include "analytic/gsl.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace slipstick::analytic::gsl {
namespace {

TEST(Root, RefusesABracketWithoutASignChange) {
  EXPECT_THROW(root([](double x) { return x * x + 1; }, 0, 2), std::runtime_error);
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
