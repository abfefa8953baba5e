#include "solver/grid/motion_field.hpp"

#include <gtest/gtest.h>

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXf;

/// The displacements of a body that is moved and turned by a little: each cell's displacement, component by
/// component.
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
