#include "solver/step/dual_norm.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "solver/grid/reduction.hpp"

namespace slipstick::solver {
namespace {

using std::numbers::pi;

// A bell exp(-r^2/2) has the transform 2 pi exp(-xi^2/2), so the integral of |xi| |v|^2 is pi^(3/2)/2; the
// mean squares of the bell and of its gradient are both pi, and bound it by pi.
TEST(DualNorm, OfABellIsTheProductOfMeanSquares) {
  const Grid grid{96, 128, 0.125, 0.125};
  const Eigen::ArrayXd bell = (-0.5 * (cell_x1(grid).square() + cell_x2(grid).square())).exp();
  const Estimate found = dual_norm_squared(grid, bell, normal_symmetry(), 2.0);
  EXPECT_NEAR(found.value, pi / 2.0, 0.002 * pi);
  EXPECT_NEAR(found.value, pi / 2.0, found.error);
  EXPECT_GT(found.value, 0.25 * std::pow(pi, 1.5));
}

TEST(DualNorm, OfAQuadrantIsAQuarterOfTheWhole) {
  const Grid whole{24, 16, 0.5, 0.4};
  const Grid grid = quadrant_of(whole);
  for (const Symmetry& symmetry : {normal_symmetry(), torsion_symmetry()}) {
    const Eigen::ArrayXd part = Eigen::ArrayXd::Random(static_cast<Index>(symmetry.size()) * grid.cells());
    const Estimate quarter = dual_norm_squared(grid, part, symmetry, 1.0);
    const Estimate all = dual_norm_squared(whole, unfold(grid, part, symmetry), symmetry, 1.0);
    EXPECT_NEAR(4.0 * quarter.value, all.value, 1e-12 * all.value);
    EXPECT_NEAR(4.0 * quarter.error, all.error, 1e-12 * all.value);
  }
}

}  // namespace
}  // namespace slipstick::solver
