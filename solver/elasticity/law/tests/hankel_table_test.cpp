#include "solver/elasticity/law/hankel_table.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace slipstick::solver {
namespace {

/// Transforms of exp(-2 x) of orders 0, 1, 2, and of x exp(-2 x) (Abramowitz and Stegun, Eq. 29.3.58).
HankelTable::Values transforms(double r) {
  const double rho = std::hypot(r, 2.0);
  const double slope = r / (rho + 2.0);
  return {1.0 / rho, slope / rho, slope * slope / rho, 2.0 / (rho * rho * rho)};
}

/// Over 1/(1 + r). It grows like the root of r.
constexpr double kTableError = 5e-13;

TEST(HankelTable, HasTheTransformsOfExponentials) {
  const HankelTable table({0, 1, 2, 0}, [](double x) {
    const double decay = std::exp(-2.0 * x);
    return HankelTable::Values{decay, decay, decay, x * decay};
  });
  for (double r = 1e-6; r < 1e7; r *= 1.37) {
    const HankelTable::Values expected = transforms(r);
    const HankelTable::Place place = table.place(r);
    for (Index term = 0; term < HankelTable::kTerms; ++term) {
      EXPECT_NEAR(HankelTable::value(place, term), expected[static_cast<std::size_t>(term)],
                  kTableError / (1.0 + r))
          << r << ", term " << term;
    }
  }
}

/// Far away only s(0) counts, whatever the order: s(0)/r.
TEST(HankelTable, EndsInOneOverTheDistance) {
  const HankelTable table({0, 1, 2, 2}, [](double x) {
    return HankelTable::Values{3.0 * std::exp(-2.0 * x), std::exp(-2.0 * x), std::exp(-3.0 * x), 0.0};
  });
  for (const double r : {1e8, 1e12, 1e200}) {
    const HankelTable::Place place = table.place(r);
    EXPECT_NEAR(r * HankelTable::value(place, 0), 3.0, 1e-7);
    EXPECT_NEAR(r * HankelTable::value(place, 1), 1.0, 1e-6);
    EXPECT_NEAR(r * HankelTable::value(place, 2), 1.0, 1e-6);
    EXPECT_EQ(HankelTable::value(place, 3), 0.0);
  }
}

}  // namespace
}  // namespace slipstick::solver
