#pragma once

#include <Eigen/Core>

#include "solver/load_step.hpp"
#include "solver/solution.hpp"

namespace slipstick::solver {

/// Two parts. Everywhere the error of cells of size h on a contact of mean radius r: h^2/(2 r^2), and h/(4 r)
/// where the pressure does not fall to zero at the edge. And where a moment is imposed, that of a stick area
/// that shrinks below a cell: the load that is missing to the limit tells the radius that the stick area
/// should have, a_s^3 = 9 (M_lim - M)/(8 mu p), p the pressure at the centre of sliding (Jaeger's
/// superposition with a smooth pressure, dH = -p ds/s); the twist grows like mu p ln(1/a_s)/(2 G) there, but
/// on a mesh no further than to a_s of about 0.6 h. Both laws' constants were set by solves of spheres, cones
/// and rounded punches at 32 and 64 cells, 0.5 to 1 - 1e-8 of the limit. Infinite where no cell is left to
/// stick though one should.
///
/// stick: one value a cell of the whole grid; twist: of the step. In the model's units (stresses
/// over G).
Resolution resolution(const Grid& grid, const LoadStep& loads, const Eigen::ArrayXd& stick, double twist);

}  // namespace slipstick::solver
