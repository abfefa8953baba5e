#pragma once

#include "solver/grid/grid.hpp"

namespace slipstick::solver {

/// Cells that counting adds at each side of a smooth edge of solved contact or stick.
inline constexpr double kCountedBySide = 0.09;
/// The same where all cells that the edge cuts are counted: half of them, of which there are as many as
/// sides.
inline constexpr double kCutBySide = 0.5;

/// inside: grid.cells() values, above zero in the cells of the area. by_side: what counting adds at each side
/// of its edge: nothing in the mean at that of a punch's face, whose cells are those with their centre on it.
CountedArea counted_area(const Grid& grid, const Eigen::ArrayXd& inside, double by_side = kCountedBySide);

}  // namespace slipstick::solver
