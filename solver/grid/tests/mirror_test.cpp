#include "solver/grid/mirror.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

constexpr Grid kQuadrant{3, 2, 0.5, 0.7, true};

TEST(Mirror, WholeGridHoldsTheQuadrantsCells) {
  const Grid whole = whole_grid(kQuadrant);
  EXPECT_EQ(whole.n1, 6);
  EXPECT_EQ(whole.n2, 4);
  EXPECT_FALSE(whole.quadrant);
  for (Index i = 0; i < kQuadrant.n1; ++i) EXPECT_EQ(whole.x1(kQuadrant.n1 + i), kQuadrant.x1(i));
  for (Index j = 0; j < kQuadrant.n2; ++j) EXPECT_EQ(whole.x2(kQuadrant.n2 + j), kQuadrant.x2(j));
}

TEST(Mirror, QuadrantOfTheWholeGridIsTheSame) {
  const Grid again = quadrant_of(whole_grid(kQuadrant));
  EXPECT_EQ(again.n1, kQuadrant.n1);
  EXPECT_EQ(again.n2, kQuadrant.n2);
  EXPECT_EQ(again.h1, kQuadrant.h1);
  EXPECT_EQ(again.h2, kQuadrant.h2);
  EXPECT_TRUE(again.quadrant);
}

TEST(Mirror, UnfoldsFieldsByTheirSymmetry) {
  const Grid whole = whole_grid(kQuadrant);
  const auto expect = [&](const auto& field, const Symmetry& symmetry) {
    EXPECT_TRUE((unfold(kQuadrant, field(kQuadrant), symmetry) == field(whole)).all());
    EXPECT_TRUE((restrict_to_quadrant(whole, field(whole)) == field(kQuadrant)).all());
  };
  expect(rotation_field, torsion_symmetry());
  expect([](const Grid& grid) -> ArrayXd { return cell_x1(grid).square() + 3.0 * cell_x2(grid).square(); },
         normal_symmetry());
  expect([](const Grid& grid) -> ArrayXd { return cell_x1(grid) * cell_x2(grid); }, {{-1, -1}});
}

TEST(Mirror, RefusesOtherGridsAndSizes) {
  const Grid whole = whole_grid(kQuadrant);
  EXPECT_THROW(whole_grid(whole), std::invalid_argument);
  EXPECT_THROW(quadrant_of(kQuadrant), std::invalid_argument);
  EXPECT_THROW(quadrant_of({3, 4, 1.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(quadrant_of({4, 3, 1.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(unfold(kQuadrant, ArrayXd::Ones(7), normal_symmetry()), std::invalid_argument);
  EXPECT_THROW(unfold(kQuadrant, ArrayXd::Ones(6), torsion_symmetry()), std::invalid_argument);
  EXPECT_THROW(unfold(whole, ArrayXd::Ones(24), normal_symmetry()), std::invalid_argument);
  EXPECT_THROW(restrict_to_quadrant(whole, ArrayXd::Ones(25)), std::invalid_argument);
  EXPECT_THROW(restrict_to_quadrant(kQuadrant, ArrayXd::Ones(6)), std::invalid_argument);
}

}  // namespace
}  // namespace slipstick::solver
