#include "solver/grid/reduction.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "solver/tests/fields.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A bowl within a radius, zero beyond: what pressures look like.
ArrayXd patch(const Grid& grid, double radius) {
  return (1.0 - (cell_x1(grid).square() + cell_x2(grid).square()) / (radius * radius)).max(0.0);
}

/// Mirrors about both axes, not about the diagonal.
ArrayXd elliptic_patch(const Grid& grid, double radius_1, double radius_2) {
  return (1.0 - (cell_x1(grid) / radius_1).square() - (cell_x2(grid) / radius_2).square()).max(0.0);
}

Index cell(const Grid& grid, Index i, Index j) { return i * grid.n2 + j; }

Reduction of(const Grid& grid, const ArrayXd& field) { return {grid, field, field}; }

void expect_grid(const Grid& grid, const Grid& expected) {
  EXPECT_EQ(grid.n1, expected.n1);
  EXPECT_EQ(grid.n2, expected.n2);
  EXPECT_EQ(grid.h1, expected.h1);
  EXPECT_EQ(grid.h2, expected.h2);
  EXPECT_EQ(grid.quadrant, expected.quadrant);
}

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

TEST(Reduction, OfACircleIsHalfAQuadrant) {
  const Reduction part = of(kSquare, patch(kSquare, 2.6));  // cells out to 5 from the axes
  EXPECT_TRUE(part.trimmed());
  EXPECT_TRUE(part.quadrant());
  EXPECT_TRUE(part.diagonal());
  expect_grid(part.grid(), {5, 5, 0.5, 0.5, true});
}

TEST(Reduction, OfAnEllipseIsAQuadrant) {
  const Reduction part = of(kSquare, elliptic_patch(kSquare, 3.6, 1.6));
  EXPECT_FALSE(part.diagonal());
  expect_grid(part.grid(), {7, 3, 0.5, 0.5, true});
  // Square, and as wide as long, but with other values.
  const ArrayXd field = patch(kSquare, 2.6) * (1.0 + 0.01 * cell_x1(kSquare).square());
  EXPECT_TRUE(of(kSquare, field).quadrant());
  EXPECT_FALSE(of(kSquare, field).diagonal());
}

TEST(Reduction, NeedsSquareCellsForTheDiagonal) {
  // As many cells along both sides, symmetric as an array: not in space.
  const Grid stretched{16, 16, 0.5, 0.5000001};
  const Reduction part(stretched, patch(kSquare, 2.6), patch(kSquare, 2.6));
  EXPECT_TRUE(part.quadrant());
  EXPECT_FALSE(part.diagonal());
}

TEST(Reduction, NeedsEvenCounts) {
  for (const Grid& grid : {Grid{15, 16, 0.5, 0.5}, Grid{16, 15, 0.5, 0.5}, Grid{15, 15, 0.5, 0.5}}) {
    const Reduction part = of(grid, patch(grid, 2.6));
    EXPECT_TRUE(part.trimmed());
    EXPECT_FALSE(part.quadrant());
    EXPECT_FALSE(part.diagonal());
    EXPECT_EQ(part.grid().n1 % 2, grid.n1 % 2) << "the origin stays in the middle";
    EXPECT_EQ(part.grid().n2 % 2, grid.n2 % 2);
  }
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
  expect_grid(part.grid(), {6, 6, 0.5, 0.5, true});
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
  expect_grid(part.grid(), {10, 10, 0.5, 0.7, false});
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
    expect_grid(part.grid(), kOblong);
    EXPECT_EQ(part.restricted(contact).sum(), 1.0);
  }
  EXPECT_FALSE(Reduction(kOblong).trimmed());
  EXPECT_FALSE(Reduction(kOblong).quadrant());
}

/// An empty contact still leaves a grid of some cells.
TEST(Trimming, OfAnEmptyFieldLeavesTheMiddle) {
  expect_grid(Reduction(kOblong, ArrayXd::Zero(kOblong.cells())).grid(), {2, 2, 0.5, 0.7, false});
  const Grid odd{7, 1, 1.0, 1.0};
  expect_grid(Reduction(odd, ArrayXd::Zero(7)).grid(), {1, 1, 1.0, 1.0, false});
}

// --- there and back ---

/// Wide, square and oblong, trimmed and not, quadrants and none.
std::vector<Reduction> reductions_of(const Grid& grid) {
  return {Reduction(grid), Reduction(grid, patch(grid, 2.6)), of(grid, patch(grid, 2.6)),
          of(grid, patch(grid, 100.0))};
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

/// Fields with the symmetry of the reduction survive it and its inverse.
TEST(ThereAndBack, SymmetricFieldsInTheContactAreKept) {
  for (const Grid& grid : {kSquare, kOblong, Grid{15, 12, 0.5, 0.5}}) {
    const ArrayXd pressure = patch(grid, 2.6);
    const ArrayXd traction = pressure.replicate(2, 1) * rotation_field(grid);
    for (const Reduction& part : reductions_of(grid)) {
      EXPECT_TRUE((part.expanded(part.restricted(pressure), normal_symmetry()) == pressure).all());
      EXPECT_TRUE((part.expanded(part.restricted(traction), torsion_symmetry()) == traction).all());
    }
  }
}

TEST(ThereAndBack, ExpandedFieldsHaveTheirParityAndAreZeroOutside) {
  const Reduction part = of(kOblong, elliptic_patch(kOblong, 2.6, 2.0));
  ASSERT_TRUE(part.quadrant());
  const Index n = kOblong.cells();
  const ArrayXd q = part.expanded(random_field(2 * part.grid().cells(), 3), torsion_symmetry());
  ASSERT_EQ(q.size(), 2 * n);
  const Index margin_1 = kOblong.n1 / 2 - part.grid().n1;
  const Index margin_2 = kOblong.n2 / 2 - part.grid().n2;
  ASSERT_GT(margin_1, 0);
  ASSERT_GT(margin_2, 0);
  for (Index i = 0; i < kOblong.n1; ++i) {
    for (Index j = 0; j < kOblong.n2; ++j) {
      const Index here = cell(kOblong, i, j);
      const Index across_1 = cell(kOblong, kOblong.n1 - 1 - i, j);
      const Index across_2 = cell(kOblong, i, kOblong.n2 - 1 - j);
      EXPECT_EQ(q[here], q[across_1]);  // q1 is even in x1 and odd in x2, q2 odd in x1 and even in x2
      EXPECT_EQ(q[here], -q[across_2]);
      EXPECT_EQ(q[here + n], -q[across_1 + n]);
      EXPECT_EQ(q[here + n], q[across_2 + n]);
      const bool outside =
          i < margin_1 || i >= kOblong.n1 - margin_1 || j < margin_2 || j >= kOblong.n2 - margin_2;
      EXPECT_EQ(q[here] == 0.0, outside);
      EXPECT_EQ(q[here + n] == 0.0, outside);
    }
  }
}

TEST(ThereAndBack, NoFieldStaysNone) {
  EXPECT_EQ(of(kSquare, patch(kSquare, 2.6)).restricted(ArrayXd()).size(), 0);
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
