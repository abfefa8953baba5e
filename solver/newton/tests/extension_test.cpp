#include "solver/newton/extension.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

TEST(Extension, CollectsAsTheAdjointOfWhatItExtends) {
  const Grid grid{9, 14, 1.0, 1.0};
  ArrayXd free = (ArrayXd::Random(grid.cells()) > 0.2).cast<double>();
  Extension extension(grid);
  extension.prepare(free);
  const ArrayXd x = free * ArrayXd::Random(grid.cells());
  const ArrayXd y = ArrayXd::Random(grid.cells());
  ArrayXd extended = x;
  extension.extend(extended);
  ArrayXd collected = y;
  extension.collect(collected);
  EXPECT_TRUE((free * extended == x).all());
  EXPECT_GT(((1.0 - free) * extended).abs().maxCoeff(), 0.0);
  // Sums of some hundreds of numbers of size one round by less.
  EXPECT_NEAR((extended * y).sum(), (x * collected).sum(), 1e-12);
}

/// Components do not see each other: together they are what each is alone.
TEST(Extension, ContinuesEachComponentByItself) {
  const Grid grid{9, 14, 1.0, 1.0};
  ArrayXd free = (ArrayXd::Random(grid.cells()) > 0.2).cast<double>();
  Extension extension(grid);
  extension.prepare(free);
  const ArrayXd fields[] = {free * ArrayXd::Random(grid.cells()), free * ArrayXd::Random(grid.cells())};
  for (const auto step : {&Extension::extend, &Extension::collect}) {
    ArrayXd together(2 * grid.cells());
    together << fields[0], fields[1];
    (extension.*step)(together);
    for (const Index k : {0, 1}) {
      ArrayXd alone = fields[k];
      (extension.*step)(alone);
      EXPECT_TRUE((together.segment(k * grid.cells(), grid.cells()) == alone).all()) << k;
    }
  }
}

/// A spot's continuation moves with it, bit by bit, also to where the grid ends, which is like cells that are
/// not free.
TEST(Extension, MovesWithTheContact) {
  const Grid grid{512, 520, 1.0, 1.0};
  constexpr Index kRows = 90;
  constexpr Index kColumns = 60;
  const Eigen::ArrayXXd spot = (Eigen::ArrayXXd::Random(kColumns, kRows) > 0.2).cast<double>();
  const Eigen::ArrayXXd values = Eigen::ArrayXXd::Random(kColumns, kRows);
  const auto placed = [&](const Eigen::ArrayXXd& part, Index row, Index column) {
    ArrayXd field = ArrayXd::Zero(grid.cells());
    Eigen::Map<Eigen::ArrayXXd>(field.data(), grid.n2, grid.n1).block(column, row, kColumns, kRows) = part;
    return field;
  };
  struct Continued {
    Eigen::ArrayXXd extended, collected;
  };
  const auto continued = [&](Index row, Index column) {
    Extension extension(grid);
    ArrayXd free = placed(spot, row, column);
    extension.prepare(free);
    ArrayXd extended = placed(spot * values, row, column);
    ArrayXd collected = placed(values, row, column);
    extension.extend(extended);
    extension.collect(collected);
    collected *= free;
    const auto window = [&](const ArrayXd& field) -> Eigen::ArrayXXd {
      return Eigen::Map<const Eigen::ArrayXXd>(field.data(), grid.n2, grid.n1)
          .block(column, row, kColumns, kRows);
    };
    return Continued{window(extended), window(collected)};
  };
  const Continued here = continued(200, 200);
  EXPECT_TRUE(((here.extended != 0.0) || (spot != 0.0)).all());  // holes are narrower than the reach
  for (const auto& [row, column] : {std::pair<Index, Index>{203, 205}, {187, 211}, {0, 0}, {422, 460}}) {
    const Continued there = continued(row, column);
    EXPECT_TRUE((there.extended == here.extended).all()) << row << ", " << column;
    EXPECT_TRUE((there.collected == here.collected).all()) << row << ", " << column;
  }
}

/// What leaves reaches the cells that stay by the adjoint: the sums of its product with any continuation
/// agree.
TEST(Extension, HandsNegativePressuresOnToTheCellsThatStay) {
  const Grid grid{9, 14, 1.0, 1.0};
  const ArrayXd free = (ArrayXd::Random(grid.cells()) > -0.5).cast<double>();
  const ArrayXd before = ArrayXd::Random(grid.cells()) + 0.5;
  const ArrayXd stays = free * (before > 0.0).cast<double>();
  ArrayXd x = stays * ArrayXd::Random(grid.cells());
  Extension extension(grid);
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
  Extension extension(grid);
  extension.hand_on(Sweep(free), free, after, mask, leaves);
  EXPECT_TRUE((after == before).all());
}

}  // namespace
}  // namespace slipstick::solver
