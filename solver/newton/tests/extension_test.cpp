#include "solver/newton/extension.hpp"

#include <gtest/gtest.h>

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

TEST(Extension, GathersAsTheAdjointOfWhatItExtends) {
  const Grid grid{9, 14, 1.0, 1.0};
  ArrayXd free = (ArrayXd::Random(grid.cells()) > 0.2).cast<double>();
  Extension<double> extension(grid);
  extension.prepare(free);
  const ArrayXd x = free * ArrayXd::Random(grid.cells());
  const ArrayXd y = ArrayXd::Random(grid.cells());
  ArrayXd extended = x;
  extension.extend(extended);
  ArrayXd gathered = y;
  extension.gather(gathered);
  EXPECT_TRUE((free * extended == x).all());
  EXPECT_GT(((1.0 - free) * extended).abs().maxCoeff(), 0.0);
  // Sums of some hundreds of numbers of size one round by less.
  EXPECT_NEAR((extended * y).sum(), (x * gathered).sum(), 1e-12);
}

/// What leaves reaches the cells that stay by the adjoint: the sums of its product with any continuation
/// agree.
TEST(Extension, HandsNegativePressuresOnToTheCellsThatStay) {
  const Grid grid{9, 14, 1.0, 1.0};
  const ArrayXd free = (ArrayXd::Random(grid.cells()) > -0.5).cast<double>();
  const ArrayXd before = ArrayXd::Random(grid.cells()) + 0.5;
  const ArrayXd stays = free * (before > 0.0).cast<double>();
  ArrayXd x = stays * ArrayXd::Random(grid.cells());
  Extension<double> extension(grid);
  ArrayXd mask(grid.cells());
  ArrayXd leaves(grid.cells());
  ArrayXd after = before;
  extension.hand_on(Sweep(ArrayXd(ArrayXd::Ones(grid.cells()))), free, after, mask, leaves);
  EXPECT_TRUE(((1.0 - stays) * after == 0.0).all());
  extension.prepare(mask = stays);
  const ArrayXd alone = x;
  extension.extend(x);
  EXPECT_NEAR(((after - stays * before) * alone).sum(), ((1.0 - stays) * before * x).sum(), 1e-12);
}

/// With nothing to hand on, nothing changes.
TEST(Extension, LeavesPositivePressuresOfFreeCellsAlone) {
  const Grid grid{9, 14, 1.0, 1.0};
  const ArrayXd free = (ArrayXd::Random(grid.cells()) > 0.0).cast<double>();
  const ArrayXd before = free * (ArrayXd::Random(grid.cells()) + 1.5);
  ArrayXd after = before;
  ArrayXd mask(grid.cells());
  ArrayXd leaves(grid.cells());
  Extension<double> extension(grid);
  extension.hand_on(Sweep(free), free, after, mask, leaves);
  EXPECT_TRUE((after == before).all());
}

}  // namespace
}  // namespace slipstick::solver
