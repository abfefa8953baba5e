#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "solver/elasticity/cell_integrals.hpp"
#include "solver/elasticity/influence.hpp"
#include "solver/elasticity/tests/components.hpp"

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

/// Square cells are mirrored about the diagonal in groups of rows, one of which crosses it here: no value may
/// be written by two threads.
TEST(InfluenceTables, AreTheSameBitsOnAnyNumberOfThreads) {
  const ElasticPair pair = elastic_pair({1.0, 0.3}, {2.5, 0.1});
  for (const auto& [m1, m2] : {std::pair<Index, Index>{77, 21}, {21, 77}, {61, 61}, {93, 42}}) {
    const auto alone = influence_tables(kComponents, pair, 1.0, 1.0, m1, m2, 1);
    for (int round = 0; round < 5; ++round) {
      for (const int threads : {2, 3, 5}) {
        EXPECT_EQ(influence_tables(kComponents, pair, 1.0, 1.0, m1, m2, threads), alone)
            << m1 << " x " << m2 << ", threads " << threads;
      }
    }
  }
}

/// Of any shape: square cells are mirrored about the diagonal, and threads share the rows.
TEST(InfluenceTables, HoldTheIntegralsOfEachOffset) {
  const ElasticPair pair = elastic_pair({1.0, 0.3}, {2.5, 0.1});
  for (const double aspect : {1.0, 0.3}) {
    for (const auto& [m1, m2] :
         {std::pair<Index, Index>{1, 1}, {3, 21}, {21, 3}, {17, 17}, {24, 24}, {9, 30}}) {
      for (const int threads : {1, 3}) {
        const auto tables = influence_tables(kComponents, pair, 1.0, aspect, m1, m2, threads);
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

}  // namespace
}  // namespace slipstick::solver
