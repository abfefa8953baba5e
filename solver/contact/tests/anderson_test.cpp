#include "solver/contact/anderson.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "solver/grid/grid.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

/// An affine map that contracts towards (1, 1, ...), in each dimension by another factor.
ArrayXd residual_at(const ArrayXd& x) {
  const ArrayXd kept = ArrayXd::LinSpaced(x.size(), -0.5, 0.9);
  return kept * (x - 1.0) + 1.0 - x;
}

double error_after(int turns, int depth, Index dimensions, double step) {
  Anderson anderson(depth);
  ArrayXd x = ArrayXd::Zero(dimensions);
  for (int turn = 0; turn < turns; ++turn) anderson.advance(x, residual_at(x), step);
  return (x - 1.0).abs().maxCoeff();
}

/// As many changes as it has dimensions span an affine map: the next combination has no residual (Walker and
/// Ni 2011: what GMRES does). The normal equations leave half the digits.
TEST(Anderson, SolvesAnAffineMapInOneTurnMoreThanItHasDimensions) {
  for (const int dimensions : {1, 2, 3, 4}) {
    for (const double step : {1.0, 0.25}) {
      EXPECT_LE(error_after(dimensions + 1, dimensions, dimensions, step), 1e-7) << dimensions;
      EXPECT_GE(error_after(dimensions, dimensions, dimensions, step), 1e-3) << dimensions;
    }
  }
}

/// With depth 0 x moves by its residual: the error shrinks by the map's largest factor, 0.9.
TEST(Anderson, OfNoDepthOnlyIterates) { EXPECT_NEAR(error_after(20, 0, 3, 1.0), std::pow(0.9, 20), 1e-14); }

/// Changes that are alike, as of a residual that no longer falls, leave the combination finite.
TEST(Anderson, BearsChangesThatSayNothingNew) {
  Anderson anderson(3);
  ArrayXd x = ArrayXd::Zero(5);
  for (int turn = 0; turn < 6; ++turn) anderson.advance(x, ArrayXd::Ones(5), 1.0);
  EXPECT_TRUE(x.isFinite().all());
}

}  // namespace
}  // namespace slipstick::solver
