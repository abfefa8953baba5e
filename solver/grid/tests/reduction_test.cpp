#include "solver/grid/reduction.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "solver/tests/fields.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A bowl within a radius, zero beyond: what pressures look like.
ArrayXd patch(const Grid& grid, double radius) {
  return (1.0 - (cell_x1(grid).square() + cell_x2(grid).square()) / (radius * radius)).max(0.0);
}

Index cell(const Grid& grid, Index i, Index j) { return i * grid.n2 + j; }

Reduction of(const Grid& grid, const ArrayXd& field) { return {grid, field, field}; }

constexpr Grid kSquare{16, 16, 0.5, 0.5};
constexpr Grid kOblong{16, 12, 0.5, 0.7};

/// Images about each axis that differ by a little less than counts as rounding: half a turn, which is both
/// mirrors, shows nearly twice as much.
ArrayXd mirrored_to_rounding(const Grid& grid) {
  constexpr double kNearlyTooMuch = 0.9e-13;
  const ArrayXd left = (cell_x1(grid) < 0.0).cast<double>();
  const ArrayXd below = (cell_x2(grid) < 0.0).cast<double>();
  return patch(grid, 2.6) * (1.0 + kNearlyTooMuch * left) * (1.0 + kNearlyTooMuch * below);
}

/// A quadrant is solved without translations, which half a turn excludes: both tests must agree.
TEST(HalfTurn, BringsWhateverIsAQuadrantOntoItself) {
  const ArrayXd field = mirrored_to_rounding(kSquare);
  ASSERT_TRUE(of(kSquare, field).quadrant());
  EXPECT_TRUE(is_half_turn_symmetric(kSquare, field));
}

TEST(HalfTurn, NeedsNoMirrors) {
  const ArrayXd turned = patch(kOblong, 2.6) * (1.0 + 0.1 * cell_x1(kOblong) * cell_x2(kOblong));
  EXPECT_FALSE(of(kOblong, turned).quadrant());
  EXPECT_TRUE(is_half_turn_symmetric(kOblong, turned));
  ArrayXd other = turned;
  other[cell(kOblong, 8, 6)] *= 1.0 + 1e-12;
  EXPECT_FALSE(is_half_turn_symmetric(kOblong, other));
}

// --- what is found ---

TEST(Reduction, NeedsSquareCellsForTheDiagonal) {
  // As many cells along both sides, symmetric as an array: not in space.
  const Grid stretched{16, 16, 0.5, 0.5000001};
  const Reduction part(stretched, patch(kSquare, 2.6), patch(kSquare, 2.6));
  EXPECT_TRUE(part.quadrant());
  EXPECT_FALSE(part.diagonal());
}

/// One cell is off by a relative error: rounding passes, a difference in the data does not.
TEST(Reduction, SeesOneCellThatIsNoImage) {
  for (const double off : {1e-10, -1e-10, 1e-12}) {
    ArrayXd field = patch(kSquare, 3.6);
    field[cell(kSquare, 5, 10)] *= 1.0 + off;
    EXPECT_FALSE(of(kSquare, field).quadrant()) << off;
    EXPECT_FALSE(of(kSquare, field).diagonal()) << off;
    // All four images alike: the axes are mirrors, the diagonal is none.
    for (const auto& [i, j] : {std::pair{5, 5}, {10, 5}, {10, 10}}) field[cell(kSquare, i, j)] *= 1.0 + off;
    EXPECT_TRUE(of(kSquare, field).diagonal()) << "on the diagonal itself";
    for (const Index i : {5, 10}) {
      for (const Index j : {6, 9}) field[cell(kSquare, i, j)] *= 1.0 + off;
    }
    EXPECT_TRUE(of(kSquare, field).quadrant()) << off;
    EXPECT_FALSE(of(kSquare, field).diagonal()) << off;
  }
  ArrayXd rounded = patch(kSquare, 3.6);
  rounded[cell(kSquare, 5, 9)] *= 1.0 + 1e-15;
  EXPECT_TRUE(of(kSquare, rounded).diagonal());
}

TEST(Reduction, NeedsBothMirrors) {
  const ArrayXd x1 = cell_x1(kSquare);
  const ArrayXd x2 = cell_x2(kSquare);
  EXPECT_FALSE(of(kSquare, patch(kSquare, 3.6) * (10.0 + x1)).quadrant());
  EXPECT_FALSE(of(kSquare, patch(kSquare, 3.6) * (10.0 + x2)).quadrant());
  // Symmetric about the origin and about both diagonals, not about the axes.
  EXPECT_FALSE(of(kSquare, patch(kSquare, 3.6) * (20.0 + x1 * x2)).quadrant());
}

/// Zero where the other is not, or infinite where the other is finite, is no image.
TEST(Reduction, ComparesZerosAndInfinities) {
  const ArrayXd reachable = (patch(kSquare, 3.1) > 0.0).cast<double>();
  ArrayXd gap = (reachable > 0.0).select(ArrayXd::Zero(256), ArrayXd::Constant(256, kInfinity));
  const Reduction part(kSquare, gap, reachable);
  EXPECT_TRUE(part.diagonal());
  EXPECT_EQ(part.grid(), (Grid{6, 6, 0.5, 0.5, true}));
  gap[cell(kSquare, 8, 3)] = kInfinity;
  EXPECT_FALSE(Reduction(kSquare, gap, reachable).quadrant());
  gap[cell(kSquare, 8, 3)] = 1e-300;
  EXPECT_FALSE(Reduction(kSquare, gap, reachable).quadrant());
  gap[cell(kSquare, 8, 3)] = std::nan("");
  EXPECT_FALSE(Reduction(kSquare, gap, reachable).quadrant());
}

/// The shape outside the contact's rectangle does not matter.
TEST(Reduction, LooksAtTheContactAlone) {
  ArrayXd shape = patch(kSquare, 2.6);
  const ArrayXd contact = shape;
  shape[0] = 7.0;
  EXPECT_TRUE(Reduction(kSquare, shape, contact).diagonal());
}

// --- trimming ---

TEST(Trimming, KeepsTheOriginInTheMiddle) {
  // One cell, in row 3 of 16 and column 10 of 12.
  ArrayXd contact = ArrayXd::Zero(kOblong.cells());
  contact[cell(kOblong, 3, 10)] = 1.0;
  const Reduction part(kOblong, contact);
  EXPECT_EQ(part.grid(), (Grid{10, 10, 0.5, 0.7, false}));
  EXPECT_EQ(part.restricted(contact).sum(), 1.0);
  EXPECT_EQ(part.restricted(contact)[cell(part.grid(), 0, 9)], 1.0);
  EXPECT_EQ((part.restricted(cell_x1(kOblong)) - cell_x1(part.grid())).abs().maxCoeff(), 0.0);
  EXPECT_EQ((part.restricted(cell_x2(kOblong)) - cell_x2(part.grid())).abs().maxCoeff(), 0.0);
  EXPECT_FALSE(Reduction(kOblong, contact, contact).quadrant());
}

TEST(Trimming, LeavesAGridWithContactInACornerAlone) {
  for (const Index corner : {Index{0}, cell(kOblong, kOblong.n1 - 1, 0)}) {
    ArrayXd contact = ArrayXd::Zero(kOblong.cells());
    contact[corner] = 1.0;
    const Reduction part(kOblong, contact);
    EXPECT_FALSE(part.trimmed());
    EXPECT_EQ(part.grid(), kOblong);
    EXPECT_EQ(part.restricted(contact).sum(), 1.0);
  }
  EXPECT_FALSE(Reduction(kOblong).trimmed());
  EXPECT_FALSE(Reduction(kOblong).quadrant());
}

/// An empty contact still leaves a grid of some cells.
TEST(Trimming, OfAnEmptyFieldLeavesTheMiddle) {
  EXPECT_EQ(Reduction(kOblong, ArrayXd::Zero(kOblong.cells())).grid(), (Grid{2, 2, 0.5, 0.7, false}));
  const Grid odd{7, 1, 1.0, 1.0};
  EXPECT_EQ(Reduction(odd, ArrayXd::Zero(7)).grid(), (Grid{1, 1, 1.0, 1.0, false}));
}

// --- there and back ---

/// Wide, square and oblong, trimmed and not, quadrants and none.
std::vector<Reduction> reductions_of(const Grid& grid) {
  return {Reduction(grid), Reduction(grid, patch(grid, 2.6)), of(grid, patch(grid, 2.6)), of(grid, patch(grid, 100.0))};
}

TEST(ThereAndBack, ExpandedFieldsComeBackUnchanged) {
  for (const Grid& grid : {kSquare, kOblong, Grid{15, 12, 0.5, 0.5}}) {
    for (const Reduction& part : reductions_of(grid)) {
      const ArrayXd scalar = random_field(part.grid().cells(), 1);
      const ArrayXd vector = random_field(2 * part.grid().cells(), 2);
      EXPECT_TRUE((part.restricted(part.expanded(scalar, normal_symmetry())) == scalar).all());
      EXPECT_TRUE((part.restricted(part.expanded(vector, torsion_symmetry())) == vector).all());
    }
  }
}

TEST(ThereAndBack, NoFieldStaysNone) { EXPECT_EQ(of(kSquare, patch(kSquare, 2.6)).restricted(ArrayXd()).size(), 0); }

// --- mirror images ---

constexpr Grid kQuadrant{3, 2, 0.5, 0.7, true};

TEST(Mirror, WholeGridHoldsTheQuadrantsCells) {
  const Grid whole = whole_grid(kQuadrant);
  EXPECT_EQ(quadrant_of(whole), kQuadrant);
  EXPECT_EQ(whole.n1, 6);
  EXPECT_EQ(whole.n2, 4);
  EXPECT_FALSE(whole.quadrant);
  for (Index i = 0; i < kQuadrant.n1; ++i) EXPECT_EQ(whole.x1(kQuadrant.n1 + i), kQuadrant.x1(i));
  for (Index j = 0; j < kQuadrant.n2; ++j) EXPECT_EQ(whole.x2(kQuadrant.n2 + j), kQuadrant.x2(j));
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

TEST(Symmetrised, IsEvenAboutTheDiagonalAndKeepsTheLoad) {
  const Grid grid{5, 5, 1.0, 1.0};
  const ArrayXd field = random_field(25, 4);
  const ArrayXd even = symmetrised(grid, field);
  for (Index i = 0; i < 5; ++i) {
    for (Index j = 0; j < 5; ++j) {
      EXPECT_EQ(even[cell(grid, i, j)], even[cell(grid, j, i)]);
      EXPECT_DOUBLE_EQ(even[cell(grid, i, j)], 0.5 * (field[cell(grid, i, j)] + field[cell(grid, j, i)]));
    }
  }
  EXPECT_NEAR(even.sum(), field.sum(), 1e-14);
  EXPECT_THROW(symmetrised({5, 4, 1.0, 1.0}, field.head(20)), std::invalid_argument);
}

}  // namespace
}  // namespace slipstick::solver
