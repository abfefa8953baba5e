#include "solver/grid/grid_transfer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "solver/grid/reduction.hpp"
#include "solver/tests/fields.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// Each value is a sum of a few products.
constexpr double kRounding = 1e-14;

/// Even, odd, prime and unequal counts, one cell, long and thin, cells that are not square.
const std::vector<Grid> kGrids{{8, 8, 1.0, 1.0},   {12, 7, 1.0, 2.0}, {13, 13, 0.5, 0.5}, {37, 10, 1.0, 0.3},
                               {31, 29, 1.0, 1.5}, {1, 6, 1.0, 1.0},  {5, 1, 2.0, 1.0},   {1, 1, 1.0, 1.0},
                               {2, 3, 1.0, 1.0},   {64, 9, 1.0, 4.0}};

class Transfer : public testing::TestWithParam<std::tuple<Grid, bool>> {
 protected:
  Transfer() : fine_(std::get<0>(GetParam())) {
    fine_.quadrant = std::get<1>(GetParam());
    coarse_ = coarser(fine_);
  }
  Grid fine_;
  Grid coarse_{};
};

std::string name_of(const testing::TestParamInfo<std::tuple<Grid, bool>>& tested) {
  const auto& [grid, quadrant] = tested.param;
  return (quadrant ? "quadrant_" : "grid_") + std::to_string(grid.n1) + "x" + std::to_string(grid.n2);
}
INSTANTIATE_TEST_SUITE_P(Sizes, Transfer, testing::Combine(testing::ValuesIn(kGrids), testing::Bool()), name_of);

double largest_difference(const ArrayXd& a, const ArrayXd& b) {
  EXPECT_EQ(a.size(), b.size());
  return a.size() == b.size() ? (a - b).abs().maxCoeff() : 1e300;
}

double overlap(double centre, double width, double other_centre, double other_width) {
  const double low = std::max(centre - 0.5 * width, other_centre - 0.5 * other_width);
  const double high = std::min(centre + 0.5 * width, other_centre + 0.5 * other_width);
  return std::max(high - low, 0.0);
}

/// Mean over each coarse cell, by the areas that the cells' rectangles share.
ArrayXd mean_by_areas(const Grid& coarse, const Grid& fine, const ArrayXd& field) {
  ArrayXd mean = ArrayXd::Zero(coarse.cells());
  for (Index i = 0; i < coarse.n1; ++i) {
    for (Index j = 0; j < coarse.n2; ++j) {
      for (Index k = 0; k < fine.n1; ++k) {
        for (Index l = 0; l < fine.n2; ++l) {
          mean[i * coarse.n2 + j] += field[k * fine.n2 + l] / coarse.cell_area() *
                                     overlap(coarse.x1(i), coarse.h1, fine.x1(k), fine.h1) *
                                     overlap(coarse.x2(j), coarse.h2, fine.x2(l), fine.h2);
        }
      }
    }
  }
  return mean;
}

TEST_P(Transfer, CoarserCoversTheSameRectangleWithHalfTheCells) {
  EXPECT_NEAR(static_cast<double>(coarse_.n1) * coarse_.h1, static_cast<double>(fine_.n1) * fine_.h1,
              kRounding * static_cast<double>(fine_.n1) * fine_.h1);
  EXPECT_NEAR(static_cast<double>(coarse_.n2) * coarse_.h2, static_cast<double>(fine_.n2) * fine_.h2,
              kRounding * static_cast<double>(fine_.n2) * fine_.h2);
  EXPECT_EQ(coarse_.n1, fine_.n1 / 2 + fine_.n1 % 2);
  EXPECT_EQ(coarse_.n2, fine_.n2 / 2 + fine_.n2 % 2);
  EXPECT_EQ(coarse_.quadrant, fine_.quadrant);
}

TEST_P(Transfer, RestrictionTakesTheMeanOverEachCoarseCell) {
  const ArrayXd field = random_field(2 * fine_.cells(), 1);
  const ArrayXd restricted = restrict_to(coarse_, fine_, field);
  ASSERT_EQ(restricted.size(), 2 * coarse_.cells());
  // Positions are differences of numbers up to 128 here.
  EXPECT_LE(
      largest_difference(restricted.head(coarse_.cells()), mean_by_areas(coarse_, fine_, field.head(fine_.cells()))),
      1e-12);
  EXPECT_LE(
      largest_difference(restricted.tail(coarse_.cells()), mean_by_areas(coarse_, fine_, field.tail(fine_.cells()))),
      1e-12);
}

/// a + b x1 + c x2 + d x1 x2, and each coordinate held at the outer coarse centres beyond them. Even in both
/// coordinates, a quadrant's field does not change between the axis and its first centre either.
TEST_P(Transfer, ProlongationIsExactForBilinearFields) {
  const auto bilinear = [](double x1, double x2) { return 0.7 + 1.3 * x1 - 0.4 * x2 + 0.2 * x1 * x2; };
  ArrayXd field(coarse_.cells());
  for (Index i = 0; i < coarse_.n1; ++i) {
    for (Index j = 0; j < coarse_.n2; ++j) {
      field[i * coarse_.n2 + j] = bilinear(coarse_.x1(i), coarse_.x2(j));
    }
  }
  const ArrayXd prolonged = prolong_to(fine_, coarse_, field, normal_symmetry());
  ASSERT_EQ(prolonged.size(), fine_.cells());
  for (Index i = 0; i < fine_.n1; ++i) {
    for (Index j = 0; j < fine_.n2; ++j) {
      const double x1 = std::clamp(fine_.x1(i), coarse_.x1(0), coarse_.x1(coarse_.n1 - 1));
      const double x2 = std::clamp(fine_.x2(j), coarse_.x2(0), coarse_.x2(coarse_.n2 - 1));
      EXPECT_NEAR(prolonged[i * fine_.n2 + j], bilinear(x1, x2), kRounding * 10.0 * field.abs().maxCoeff())
          << i << ' ' << j;
    }
  }
}

class QuadrantTransfer : public testing::TestWithParam<Grid> {};
INSTANTIATE_TEST_SUITE_P(Sizes, QuadrantTransfer, testing::ValuesIn(kGrids), [](const auto& tested) {
  return std::to_string(tested.param.n1) + "x" + std::to_string(tested.param.n2);
});

/// Transfer to another grid and unfolding of a quadrant commute.
TEST_P(QuadrantTransfer, IsThatOfTheMirrorImages) {
  Grid fine = GetParam();
  fine.quadrant = true;
  const Grid coarse = coarser(fine);
  const Symmetry all{{1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
  const ArrayXd on_coarse = random_field(4 * coarse.cells(), 3);
  const ArrayXd whole = prolong_to(whole_grid(fine), whole_grid(coarse), unfold(coarse, on_coarse, all), all);
  EXPECT_LE(largest_difference(unfold(fine, prolong_to(fine, coarse, on_coarse, all), all), whole), kRounding);

  const ArrayXd on_fine = random_field(4 * fine.cells(), 4);
  const ArrayXd restricted = restrict_to(whole_grid(coarse), whole_grid(fine), unfold(fine, on_fine, all));
  EXPECT_LE(largest_difference(unfold(coarse, restrict_to(coarse, fine, on_fine), all), restricted), 10.0 * kRounding);
}

TEST(CanCoarsen, EndsWithAFewCellsAlongEachSide) {
  for (const bool quadrant : {false, true}) {
    for (const auto& [n1, n2] : std::vector<std::pair<Index, Index>>{
             {1, 1}, {1, 4096}, {4096, 1}, {3, 100000}, {17, 4096}, {512, 512}, {1023, 61}, {100000, 100000}}) {
      Grid grid{n1, n2, 1.0, 1.0, quadrant};
      int steps = 0;
      for (; can_coarsen(grid); grid = coarser(grid)) ASSERT_LT(++steps, 20) << n1 << " x " << n2;
      // A few cells remain across the whole contact, half of them in a quadrant, and from a long side few.
      const Index images = quadrant ? 2 : 1;
      const Index across = images * std::min(grid.n1, grid.n2);
      EXPECT_TRUE(steps == 0 || across >= 6) << n1 << " x " << n2;
      EXPECT_LT(across, 32) << n1 << " x " << n2;
    }
  }
}

/// Means over any cells keep the integral, where edge cells extend beyond the edge; means over the same cells
/// are the field.
TEST(MeansOn, OtherCellsHoldTheIntegral) {
  const Grid from{13, 9, 0.5, 2.0};
  const ArrayXd field = random_field(from.cells(), 3);
  EXPECT_TRUE((means_on(from, from, field) == field).all());
  for (const auto& [cells, size] : {std::pair{4, 13.0 * 0.5 / 4.0}, {5, 13.0 * 0.5 / 5.0}, {39, 0.5 / 3.0}}) {
    const Grid to{cells, 3, size, 6.0};
    EXPECT_NEAR(means_on(to, from, field).mean(), field.mean(), kRounding);
  }
  const Grid part{2, 3, 1.0, 2.0};
  const ArrayXd moved = means_on(part, from, field, {1.25, -4.0});  // from cells (7, 1) on, two by one
  for (Index i = 0; i < 2; ++i) {
    for (Index j = 0; j < 3; ++j) {
      const double expected = 0.5 * (field[(7 + 2 * i) * from.n2 + 1 + j] + field[(8 + 2 * i) * from.n2 + 1 + j]);
      EXPECT_NEAR(moved[i * 3 + j], expected, kRounding);
    }
  }
  EXPECT_EQ(means_on({1, 1, 1.0, 1.0}, from, field, {-100.0, 100.0})[0], field[8]);
}

TEST(GridTransfer, AFieldSpreadOverPartsHasItsMeans) {
  const Grid coarse{3, 5, 1.0, 0.5};
  const Grid fine = divided(coarse, 3);
  EXPECT_EQ(fine.n1, 9);
  EXPECT_DOUBLE_EQ(9.0 * fine.cell_area(), coarse.cell_area());
  const ArrayXd field = ArrayXd::LinSpaced(2 * coarse.cells(), 1.0, 2.0);
  const ArrayXd spread = spread_to(fine, coarse, field);
  EXPECT_TRUE(restrict_to(coarse, fine, spread).isApprox(field, 1e-14));
  EXPECT_EQ(spread[4 * fine.n2 + 7], field[1 * coarse.n2 + 2]);
}

}  // namespace
}  // namespace slipstick::solver
