#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "solver/grid/grid.hpp"

/// Fields from one grid to another.
namespace slipstick::solver {

/// Half as many cells along each axis (rounded up).
Grid coarser(const Grid& grid);

/// True if coarser(grid) is worth a solve: each side of the contact keeps at least a few cells.
bool can_coarsen(const Grid& grid);

/// `parts` cells along each side of a cell.
Grid divided(const Grid& grid, Index parts);

/// The value of each coarse cell in all of its parts, on fine = divided(coarse, parts); one or several components.
Eigen::ArrayXd spread_to(const Grid& fine, const Grid& coarse, const Eigen::ArrayXd& field);

/// Mean over each coarse cell; one or several components.
Eigen::ArrayXd restrict_to(const Grid& coarse, const Grid& fine, const Eigen::ArrayXd& field);

/// Mean over each cell of the grid `to`, whose centre is at `centre` in the coordinates of `from`, in the
/// same unit. Outside `from` the field has the value of the nearest edge cell. One component.
Eigen::ArrayXd means_on(const Grid& to, const Grid& from, const Eigen::ArrayXd& field,
                        const std::array<double, 2>& centre = {});

/// Linear interpolation between the coarse centres, continued beyond the outer ones as a constant and across
/// a quadrant's axes by each component's parity.
Eigen::ArrayXd prolong_to(const Grid& fine, const Grid& coarse, const Eigen::ArrayXd& field,
                          std::span<const Parity> parities);

}  // namespace slipstick::solver
