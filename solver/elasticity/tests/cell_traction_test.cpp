#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "solver/elasticity/influence.hpp"

namespace slipstick::solver {
namespace {

/// Displacement at the middle of the traction exp(-r^2), given on cells of h by aspect h.
double middle_of_gaussian(Component component, const ElasticPair& pair, double h, double aspect) {
  const auto m1 = static_cast<Index>(6.5 / h);
  const auto m2 = static_cast<Index>(6.5 / (h * aspect));
  const auto table = influence_coefficients(component, pair, h, h * aspect, m1, m2);
  double sum = 0.0;
  for (Index k1 = 0; k1 < m1; ++k1) {
    for (Index k2 = 0; k2 < m2; ++k2) {
      const double x = h * static_cast<double>(k1);
      const double y = h * aspect * static_cast<double>(k2);
      const double images = (k1 > 0 ? 2.0 : 1.0) * (k2 > 0 ? 2.0 : 1.0);
      sum += images * std::exp(-x * x - y * y) * table[static_cast<std::size_t>(k1 * m2 + k2)];
    }
  }
  return sum;
}

/// 1/rho integrates to pi^(3/2), and both x^2/rho^3 and y^2/rho^3 to half of it.
TEST(CellTractions, AreRightToTheSecondOrderAndSmoothOnesToTheThird) {
  ElasticPair pair = elastic_pair({1.0, 0.3}, {2.5, 0.1});
  const double potential = 0.5 * std::sqrt(std::numbers::pi);
  const double shear = (pair.shear_compliance - 0.5 * pair.poisson_compliance) * potential;
  for (const double aspect : {1.0, 0.7}) {
    for (const auto& [component, exact] : {std::pair{Component::k11, shear},
                                           {Component::k22, shear},
                                           {Component::k33, pair.normal_compliance * potential}}) {
      const auto error = [&, exact = exact, component = component](CellTraction traction, double h) {
        pair.cell_traction = traction;
        return std::abs(middle_of_gaussian(component, pair, h, aspect) / exact - 1.0);
      };
      const double order_of_constant =
          std::log2(error(CellTraction::constant, 0.1) / error(CellTraction::constant, 0.05));
      EXPECT_NEAR(order_of_constant, 2.0, 0.1);
      EXPECT_GE(error(CellTraction::smooth, 0.1) / error(CellTraction::smooth, 0.05), 7.0);
      EXPECT_LE(error(CellTraction::smooth, 0.05), 0.1 * error(CellTraction::constant, 0.05));
    }
  }
}

}  // namespace
}  // namespace slipstick::solver
