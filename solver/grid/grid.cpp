#include "solver/grid/grid.hpp"

#include <algorithm>

namespace slipstick::solver {

Index fast_length(Index minimum) {
  for (Index length = std::max<Index>(minimum + minimum % 2, 4);; length += 2) {
    Index rest = length;
    for (const Index factor : {2, 3, 5, 7}) {
      while (rest % factor == 0) rest /= factor;
    }
    if (rest == 1) return length;
  }
}

Eigen::ArrayXd cell_x1(const Grid& grid) {
  Eigen::ArrayXd x(grid.cells());
  for (Index i = 0; i < grid.n1; ++i) x.segment(i * grid.n2, grid.n2).setConstant(grid.x1(i));
  return x;
}

Eigen::ArrayXd cell_x2(const Grid& grid) {
  Eigen::ArrayXd x(grid.cells());
  for (Index i = 0; i < grid.n1; ++i) {
    for (Index j = 0; j < grid.n2; ++j) x[i * grid.n2 + j] = grid.x2(j);
  }
  return x;
}

Eigen::ArrayXd rotation_field(const Grid& grid) {
  Eigen::ArrayXd t(2 * grid.cells());
  t.head(grid.cells()) = -cell_x2(grid);
  t.tail(grid.cells()) = cell_x1(grid);
  return t;
}

}  // namespace slipstick::solver
