#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "solver/grid/grid.hpp"

namespace slipstick::convergence {

/// Pressure and shear tractions that some program computed, over the bounding rectangle of its contact cells.
/// Cells that its file does not hold carry nothing.
struct ForeignField {
  std::filesystem::path file;
  solver::Grid grid;                 ///< m, about its own centre
  std::array<double, 2> centre;      ///< m, of the grid in the scene's coordinates
  Eigen::ArrayXd pressure;           ///< cells, Pa
  Eigen::ArrayXd traction;           ///< 2*cells, Pa, on the lower body
  Eigen::ArrayXd pressure_rounding;  ///< cells: what the file's digits leave open
  Eigen::ArrayXd traction_rounding;  ///< cells, of |q|
};

/// Reads the columns x1, x2, pressure, q1, q2, as solver::read_columns() does (`columns` are those of its
/// options; others are ignored), with their numbers as they stand. Where the pressure is NaN or a cell
/// without pressure has a traction that is NaN, there is no contact. Throws InputError for a column that is
/// missing, another value that is not finite, a negative pressure, tractions that are all zero, and what
/// find_field_grid() refuses.
ForeignField read_foreign_field(const std::filesystem::path& file,
                                const std::vector<std::string>& columns = {});

}  // namespace slipstick::convergence
