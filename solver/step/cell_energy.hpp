#pragma once

#include <Eigen/Core>

#include "solver/elasticity/elasticity.hpp"
#include "solver/grid/reduction.hpp"
#include "solver/step/dual_norm.hpp"

namespace slipstick::solver {

/// The part of the integral q.Kq/2 that a sum over the outer 8 of 3 x 3 parts of each cell misses, over
/// cells with constant tractions q: displacements grow like x ln x at a cell's sides. It comes from the cell
/// itself and from 5 x 5 cells around it, whose mean displacements are sums over 15 x 15 and 5 x 5 parts,
/// extrapolated. The error compares sums over 9 x 9 and 3 x 3 parts.
///
/// q: one value a cell for each component of the kernel, mirrored across a quadrant's axes by symmetry. In
/// the units of the law and the grid, as the integral.
Estimate missing_energy(const Elasticity& elasticity, const Grid& grid, const Eigen::ArrayXd& q,
                        const BlockKernel& kernel, const Symmetry& symmetry);

}  // namespace slipstick::solver
