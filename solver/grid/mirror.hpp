#pragma once

#include <Eigen/Core>
#include <vector>

#include "solver/grid/grid.hpp"

/// Fields with two mirror axes, on the whole grid and on its quadrant x1, x2 > 0.
namespace slipstick::solver {

/// How a field continues across the mirror axes: the parity of each of its components.
using Symmetry = std::vector<Parity>;

/// Even in both coordinates: normal pressure and displacement.
Symmetry normal_symmetry();
/// (q1, q2) and (u1, u2) under torsion, as (-x2, x1) is: even and odd, odd and even.
Symmetry torsion_symmetry();

/// The grid of 2 n1 x 2 n2 cells. Throws std::invalid_argument for a grid that is no quadrant.
Grid whole_grid(const Grid& quadrant);

/// Throws std::invalid_argument for a quadrant, and for odd counts of cells: an axis would cut cells in two.
Grid quadrant_of(const Grid& whole);

/// A field on the quadrant and its mirror images, on whole_grid(quadrant): each component of n1 n2 values,
/// one for each parity, becomes 4 n1 n2 values. Throws std::invalid_argument for another size, and as
/// whole_grid.
Eigen::ArrayXd unfold(const Grid& quadrant, const Eigen::ArrayXd& field, const Symmetry& symmetry);

/// The part of a field of any number of components that lies on quadrant_of(whole). Throws
/// std::invalid_argument for a field of another size, and as quadrant_of.
Eigen::ArrayXd restrict_to_quadrant(const Grid& whole, const Eigen::ArrayXd& field);

}  // namespace slipstick::solver
