#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "solver/grid/grid.hpp"
#include "solver/input/field_file.hpp"

namespace slipstick::convergence {

/// The regular grid that the cells of a field lie on, worked out from their positions.
struct FieldGrid {
  solver::Grid grid;                 ///< the cells' bounding rectangle, in the file's unit of length
  std::array<double, 2> centre;      ///< of that rectangle, in the file's coordinates
  std::vector<solver::Index> cells;  ///< for each row of the file its cell on the grid
};

/// x1, x2: positions of the cells' centres, in any order, rounded to as few digits as still distinguish them;
/// cells may be missing. Throws InputError, with file, row and value, for positions on no regular grid, a
/// cell that is given twice, and too few cells to judge.
FieldGrid find_field_grid(const std::filesystem::path& file, const solver::Column& x1,
                          const solver::Column& x2);

}  // namespace slipstick::convergence
