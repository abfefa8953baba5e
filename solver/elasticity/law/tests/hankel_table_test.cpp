#include "solver/elasticity/law/hankel_table.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace slipstick::solver {
namespace {

/// exp(-2 x) by orders 0, 1, 2 and x exp(-2 x) by order 0 (Abramowitz and Stegun, Eq. 29.3.58).
TEST(HankelTable, HasTheTransformsOfExponentials) {
  const HankelTable table({0, 1, 2, 0}, [](double x) {
    const double decay = std::exp(-2.0 * x);
    return HankelTable::Values{decay, decay, decay, x * decay};
  });
  const auto expect_near = [&](double r, double tolerance) {
    const double rho = std::hypot(r, 2.0);
    const double slope = r / (rho + 2.0);
    const HankelTable::Values expected{1.0 / rho, slope / rho, slope * slope / rho, 2.0 / rho / rho / rho};
    for (std::size_t term = 0; term < expected.size(); ++term) {
      EXPECT_NEAR(HankelTable::value(table.place(r), term), expected[term], tolerance / (1.0 + r)) << r;
    }
  };
  for (double r = 1e-6; r < 1e7; r *= 1.37) expect_near(r, 5e-13);
  for (const double r : {1e8, 1e12, 1e150}) expect_near(r, 2e-7);  // the tail 1/r
}

}  // namespace
}  // namespace slipstick::solver
