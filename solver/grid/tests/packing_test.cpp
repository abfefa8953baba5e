#include "solver/grid/packing.hpp"

#include <gtest/gtest.h>

#include "solver/allocations/allocations.hpp"
#include "solver/grid/motion_field.hpp"
#include "solver/tests/fields.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// Spots on a grid of several bands, all of its cells, and one.
class PackingOf : public testing::TestWithParam<double> {
 protected:
  const Grid grid_{70, 40, 0.5, 0.25};
  const Index cells_ = grid_.cells();
  const ArrayXd random_ = random_field(cells_, 1);
  const ArrayXd kept_ = (random_ >= GetParam()).select(random_ + 2.0, 0.0);
  const Sweep sweep_{grid_, kept_};
};
const double kOneCell = random_field(70 * 40, 1).maxCoeff();
INSTANTIATE_TEST_SUITE_P(Spots, PackingOf, testing::Values(-1.0, 0.0, 0.9, kOneCell));

TEST_P(PackingOf, KeepsItsCellsInTheirOrderAndPutsThemBack) {
  const Packing packing(grid_, sweep_, 2);
  const ArrayXd field = random_field(2 * cells_, 2);
  const ArrayXd packed = packing.packed(field);
  ASSERT_EQ(packed.size(), 2 * sweep_.count());
  EXPECT_TRUE((packing.unpacked(packed) == (kept_ != 0.0).replicate(2, 1).select(field, 0.0)).all());
  Index place = 0;
  for (Index cell = 0; cell < cells_; ++cell) {
    if (kept_[cell] == 0.0) {
      EXPECT_LT(packing.place(cell), 0);
      continue;
    }
    EXPECT_EQ(packing.place(cell), place);
    EXPECT_EQ(packed[place], field[cell]);
    EXPECT_EQ(packed[sweep_.count() + place], field[cells_ + cell]);
    ++place;
  }
}

/// Each once, and with the same sums on any number of threads.
TEST_P(PackingOf, VisitsEachCell) {
  const Packing packing(grid_, sweep_, 1);
  const ArrayXd values = packing.packed(random_field(cells_, 3).exp());
  const auto sum = [&] {
    return packing.cells().sum<double>(
        [&](Index first, Index last, double& part) { part += values.segment(first, last - first).sum(); });
  };
  ArrayXd visits = ArrayXd::Zero(values.size());
  packing.cells().each([&](Index first, Index last) { visits.segment(first, last - first) += 1.0; });
  EXPECT_TRUE((visits == 1.0).all());
  EXPECT_EQ(packing.cells().is_ragged(), sweep_.is_ragged());
  const double alone = sum();
  EXPECT_NEAR(alone, values.sum(), 1e-14 * values.sum());
  const ThreadPool pool(3);
  EXPECT_EQ(sum(), alone);
}

TEST_P(PackingOf, WorksOnTheGridWithoutAllocating) {
  Packing packing(grid_, sweep_, 1);
  const ArrayXd x = packing.packed(random_field(cells_, 4));
  ArrayXd y(x.size());
  const ArrayXd factors = random_field(cells_, 5);
  const long before = allocations();
  packing.on_grid(x, y, [&](const ArrayXd& in, ArrayXd& out) {
    for (Index cell = 0; cell < cells_; ++cell) out[cell] = factors[cell] * in[cell];
  });
  EXPECT_EQ(allocations(), before);
  EXPECT_TRUE((y == x * packing.packed(factors)).all());
}

TEST_P(PackingOf, MovesAsTheGridDoes) {
  const Packing packing(grid_, sweep_, 1);
  const MotionField motion(grid_, 0.25, -1.5, 0.8);
  const MotionField packed = motion.packed(packing);
  const ArrayXd expected = packing.packed((ArrayXd(2 * cells_) << 0.25 - 0.8 * cell_x2(grid_),  //
                                           -1.5 + 0.8 * cell_x1(grid_))
                                              .finished());
  packing.cells().each([&](Index first, Index last) {
    for (const Index start : {first, sweep_.count() + first}) {
      const ArrayXd part = expected.segment(start, last - first);
      EXPECT_LE((packed.segment(start, last - first) - part).abs().maxCoeff(), 1e-14);
      EXPECT_NEAR(packed.dot(start, part), part.square().sum(), 1e-12 * part.square().sum());
    }
  });
}

/// The displacements of a body that is moved and turned by a little: each cell's displacement, component by component.
TEST(MotionField, IsTheDisplacementOfEachCell) {
  for (const Grid& grid : {Grid{6, 5, 0.3, 0.7}, Grid{4, 3, 0.5, 0.2, true}}) {
    const MotionField motion(grid, 0.25, -1.5, 0.8);
    const ArrayXd expected = (ArrayXd(2 * grid.cells()) << 0.25 - 0.8 * cell_x2(grid),  //
                              -1.5 + 0.8 * cell_x1(grid))
                                 .finished();
    const double rounding = 1e-15 * expected.abs().maxCoeff();
    for (Index first = 0; first < expected.size(); ++first) {
      const Index n = grid.n2 - first % grid.n2;  // to the end of its row
      const ArrayXd in_row = expected.segment(first, n);
      EXPECT_LE((motion.segment(first, n) - in_row).abs().maxCoeff(), rounding);

      const ArrayXd values = ArrayXd::LinSpaced(n, -1.0, 3.0);
      EXPECT_NEAR(motion.dot(first, values), (values * in_row).sum(), 1e-14);
      ArrayXd sum = values;
      motion.add_to(sum, first, -2.0);
      EXPECT_LE((sum - (values - 2.0 * in_row)).abs().maxCoeff(), 10.0 * rounding);
    }
  }
}

/// The unit motions are exact: no rounding enters a force or a moment through them.
TEST(MotionField, OfAUnitMotionIsExact) {
  const Grid grid{6, 4, 0.3, 0.7};
  const MotionField turn(grid, 0.0, 0.0, 1.0);
  const MotionField along1(grid, 1.0);
  const ArrayXd rotation = rotation_field(grid);
  for (Index first = 0; first < 2 * grid.cells(); first += grid.n2) {
    EXPECT_TRUE((turn.segment(first, grid.n2) == rotation.segment(first, grid.n2)).all());
    EXPECT_TRUE((along1.segment(first, grid.n2) == (first < grid.cells() ? 1.0 : 0.0)).all());
  }
}

}  // namespace
}  // namespace slipstick::solver
