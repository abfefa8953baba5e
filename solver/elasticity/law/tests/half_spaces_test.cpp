#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "solver/elasticity/law/cell_integrals.hpp"
#include "solver/elasticity/law/half_spaces.hpp"
#include "solver/elasticity/law/tests/components.hpp"

namespace slipstick::solver {
namespace {

/// Each component composed of the cell integrals (Johnson 1985, section 3.6), in kComponents' order.
std::array<double, 6> composed(const ElasticPair& pair, const CellIntegrals& c) {
  const double half = 0.5 / std::numbers::pi;
  const double shear = half * pair.shear_compliance;
  const double poisson = half * pair.poisson_compliance;
  return {shear * c.xx + (shear - poisson) * c.yy, poisson * c.xy,
          shear * c.yy + (shear - poisson) * c.xx, -0.5 * half * pair.mismatch * c.x,
          -0.5 * half * pair.mismatch * c.y,       half * pair.normal_compliance * (c.xx + c.yy)};
}

/// Square cells are mirrored about the diagonal in groups of rows, and one group crosses it here: no value
/// may be written by two threads.
TEST(InfluenceTables, AreTheSameBitsOnAnyNumberOfThreads) {
  const HalfSpaces law(elastic_pair({1.0, 0.3}, {2.5, 0.1}));
  for (const auto& [m1, m2] : {std::pair<Index, Index>{77, 21}, {21, 77}, {61, 61}, {93, 42}}) {
    const auto alone = law.influence_tables(kComponents, {m1, m2, 1.0, 1.0});
    for (int round = 0; round < 5; ++round) {
      for (const int threads : {2, 3, 5}) {
        EXPECT_EQ(law.influence_tables(kComponents, {m1, m2, 1.0, 1.0}, threads), alone)
            << m1 << " x " << m2 << ", threads " << threads;
      }
    }
  }
}

/// Tables of any shape: square cells are mirrored about the diagonal, and threads share the rows.
TEST(InfluenceTables, HoldTheIntegralsOfEachOffset) {
  const ElasticPair pair = elastic_pair({1.0, 0.3}, {2.5, 0.1});
  for (const double aspect : {1.0, 0.3}) {
    for (const auto& [m1, m2] :
         {std::pair<Index, Index>{1, 1}, {3, 21}, {21, 3}, {17, 17}, {24, 24}, {9, 30}}) {
      for (const int threads : {1, 3}) {
        const auto tables = HalfSpaces(pair).influence_tables(kComponents, {m1, m2, 1.0, aspect}, threads);
        ASSERT_EQ(tables.size(), kComponents.size());
        for (Index k = 0; k < m1 * m2; ++k) {
          const double x = static_cast<double>(k / m2);
          const double y = static_cast<double>(k % m2) * aspect;
          const auto expected = composed(pair, cell_integrals(x, y, 1.0, aspect));
          for (std::size_t i = 0; i < tables.size(); ++i) {
            ASSERT_NEAR(tables[i][static_cast<std::size_t>(k)], expected[i],
                        kPromised * std::abs(expected[i]));
          }
        }
      }
    }
  }
}

/// Displacement at the middle of the traction exp(-r^2), given on cells of h by aspect h.
double middle_of_gaussian(Component component, const HalfSpaces& law, double h, double aspect) {
  const auto m1 = static_cast<Index>(6.5 / h);
  const auto m2 = static_cast<Index>(6.5 / (h * aspect));
  const auto table = law.influence_coefficients(component, {m1, m2, h, h * aspect});
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
  const ElasticPair pair = elastic_pair({1.0, 0.3}, {2.5, 0.1});
  const double potential = 0.5 * std::sqrt(std::numbers::pi);
  const double shear = (pair.shear_compliance - 0.5 * pair.poisson_compliance) * potential;
  for (const double aspect : {1.0, 0.7}) {
    for (const auto& [component, exact] : {std::pair{Component::k11, shear},
                                           {Component::k22, shear},
                                           {Component::k33, pair.normal_compliance * potential}}) {
      const auto error = [&, exact = exact, component = component](CellTraction traction, double h) {
        return std::abs(middle_of_gaussian(component, HalfSpaces(pair, traction), h, aspect) / exact - 1.0);
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
