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

}  // namespace
}  // namespace slipstick::solver
