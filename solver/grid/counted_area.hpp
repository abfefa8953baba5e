#pragma once

#include "solver/grid/grid.hpp"

namespace slipstick::solver {

/// Cells that counting adds per cell side along a smooth edge of solved contact or stick.
inline constexpr double kCountedBySide = 0.09;
/// The same where every cell that the edge cuts is counted: half a cell per side.
inline constexpr double kCutBySide = 0.5;

/// inside: grid.cells() values, above zero in the cells of the area. by_side: cells that counting adds per
/// side of the edge; 0 for a punch's face, which has the cells whose centres lie on it.
CountedArea counted_area(const Grid& grid, const Eigen::ArrayXd& inside, double by_side = kCountedBySide);

}  // namespace slipstick::solver
