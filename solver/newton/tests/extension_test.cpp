#include "solver/newton/extension.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "solver/newton/tangent_space.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

TEST(Extension, CollectsAsTheAdjointOfWhatItExtends) {
  const Grid grid{9, 14, 1.0, 1.0};
  ArrayXd free = (ArrayXd::Random(grid.cells()) > 0.2).cast<double>();
  Extension extension(grid, 1);
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

/// Where no cell slips the components are independent of each other.
TEST(Extension, ContinuesEachComponentByItself) {
  const Grid grid{9, 14, 1.0, 1.0};
  ArrayXd free = (ArrayXd::Random(grid.cells()) > 0.2).cast<double>();
  Extension extension(grid, 1);
  extension.prepare(free);
  Extension of_vectors(grid, 2);
  of_vectors.prepare(free);
  const ArrayXd fields[] = {free * ArrayXd::Random(grid.cells()), free * ArrayXd::Random(grid.cells())};
  for (const auto step : {&Extension::extend, &Extension::collect}) {
    ArrayXd together(2 * grid.cells());
    together << fields[0], fields[1];
    (of_vectors.*step)(together);
    for (const Index k : {0, 1}) {
      ArrayXd alone = fields[k];
      (extension.*step)(alone);
      EXPECT_TRUE((together.segment(k * grid.cells(), grid.cells()) == alone).all()) << k;
    }
  }
}

/// The free part of slipping vectors is continued in the same way: across their line as outside the contact,
/// along it in proportion to the stiffness.
TEST(Extension, ContinuesWhatSlipHoldsFast) {
  const Grid grid{9, 150, 1.0, 1.0};
  const Index n = grid.cells();
  ArrayXd contact = (ArrayXd::Random(n) > -0.5).cast<double>();
  for (Index i = 0; i < n; ++i) {
    if (i % grid.n2 > 40) contact[i] = 1.0;  // much of it far from the contact's edge
  }
  const Packing packing(grid, Sweep(grid, contact), 2);
  TangentSpace space(2, packing.cells());
  const ArrayXd slips = ArrayXd::Random(packing.cells().size());
  for (Index i = 0; i < slips.size(); ++i) {
    space.set(i, true);
    if (slips[i] > 0.0) space.set_line(i, std::cos(slips[i]), std::sin(slips[i]), slips[i] < 0.5 ? 0.0 : 1.0, 1.0);
  }
  const auto free_part = [&](const ArrayXd& field) {
    ArrayXd part = packing.packed(field);
    space.project(0, slips.size(), part);
    return packing.unpacked(part);
  };
  Extension extension(grid, 2);
  extension.prepare(space, packing);
  const ArrayXd x = free_part(ArrayXd::Random(2 * n));
  const ArrayXd y = ArrayXd::Random(2 * n);
  ArrayXd extended = x;
  extension.extend(extended);
  ArrayXd collected = y;
  extension.collect(collected);
  EXPECT_NEAR((extended * y).sum(), (x * free_part(collected)).sum(), 1e-12);
  const ArrayXd added = extended - x;
  for (Index cell = 0; cell < n; ++cell) {
    const double size = std::abs(added[cell]) + std::abs(added[cell + n]);
    const Index i = packing.place(cell);
    EXPECT_EQ(size == 0.0, i >= 0 && !space.on_line(i)) << cell;
    if (i < 0 || !space.on_line(i)) continue;
    const double along = std::abs(added[cell] * space.f1[i] + added[cell + n] * space.f2[i]);
    constexpr double kRoundedToFloat = 2e-6;  // matrices, of sums of size ten
    if (space.scale[i] == 1.0F) {
      EXPECT_LE(along, kRoundedToFloat) << i;
    }
    if (space.scale[i] < 1.0F) {
      EXPECT_GT(along, 0.0) << i;
    }
  }
}

/// A spot's continuation moves with it by whole blocks, bit by bit, also to where the grid ends, which is
/// like cells that are not free. Borrowed memory full of NaN gives the same bits.
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
  ArrayXd borrowed = ArrayXd::Constant(grid.cells(), std::numeric_limits<double>::quiet_NaN());
  const auto continued = [&](Index row, Index column, std::span<double> memory = {}) {
    Extension extension(grid, 1, memory);
    ArrayXd free = placed(spot, row, column);
    ArrayXd extended = placed(spot * values, row, column);
    ArrayXd collected = placed(values, row, column);
    extension.prepare(free);
    borrowed.setConstant(std::numeric_limits<double>::quiet_NaN());
    extension.extend(extended);
    borrowed.setConstant(std::numeric_limits<double>::quiet_NaN());
    extension.collect(collected);
    collected *= free;
    const auto window = [&](const ArrayXd& field) -> Eigen::ArrayXXd {
      return Eigen::Map<const Eigen::ArrayXXd>(field.data(), grid.n2, grid.n1).block(column, row, kColumns, kRows);
    };
    return Continued{window(extended), window(collected)};
  };
  const Continued here = continued(192, 208);
  EXPECT_TRUE(((here.extended != 0.0) || (spot != 0.0)).all());  // holes are narrower than the reach
  for (const auto& [row, column] : {std::pair<Index, Index>{208, 192}, {176, 256}, {0, 0}, {416, 448}}) {
    const Continued there = continued(row, column, std::span(borrowed.data(), static_cast<std::size_t>(grid.cells())));
    EXPECT_TRUE((there.extended == here.extended).all()) << row << ", " << column;
    EXPECT_TRUE((there.collected == here.collected).all()) << row << ", " << column;
  }
}

/// Removed pressures reach the remaining cells by the adjoint: products with any continuation agree.
TEST(Extension, HandsNegativePressuresOnToTheCellsThatStay) {
  const Grid grid{9, 14, 1.0, 1.0};
  const ArrayXd free = (ArrayXd::Random(grid.cells()) > -0.5).cast<double>();
  const ArrayXd before = ArrayXd::Random(grid.cells()) + 0.5;
  const ArrayXd stays = free * (before > 0.0).cast<double>();
  ArrayXd x = stays * ArrayXd::Random(grid.cells());
  Extension extension(grid, 1);
  ArrayXd mask(grid.cells());
  ArrayXd leaves(grid.cells());
  ArrayXd after = before;
  Packing all(grid, Sweep::whole(grid), 1);
  extension.redistribute(all, free, after, mask, leaves);
  EXPECT_TRUE(((1.0 - stays) * after == 0.0).all());
  extension.prepare(mask = stays);
  const ArrayXd alone = x;
  extension.extend(x);
  EXPECT_NEAR(((after - stays * before) * alone).sum(), ((1.0 - stays) * before * x).sum(), 1e-12);
}

}  // namespace
}  // namespace slipstick::solver
