#pragma once

#include "solver/grid/grid.hpp"

namespace slipstick::solver {

/// inside: grid.cells() values, above zero in the cells of the area. is_face: its edge is that of a punch's
/// face, whose cells are those with their centre on it: then counting is right in the mean.
CountedArea counted_area(const Grid& grid, const Eigen::ArrayXd& inside, bool is_face = false);

}  // namespace slipstick::solver
