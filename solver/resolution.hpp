#pragma once

#include <Eigen/Core>

#include "solver/load_step.hpp"
#include "solver/solution.hpp"

namespace slipstick::solver {

/// Three parts. Everywhere the error of cells of size h on a contact of radius r, h/r in the root mean square
/// of both axes: h^2/(2 r^2), and h/(4 r) where the pressure does not fall to zero at the edge. Where slip is
/// narrower than a cell, four times the first on top, since tractions rise towards the edge as if nothing
/// bounded them: the error of spheres, cones and rounded punches on 8 to 64 cells at loads of 1e-6 to 0.1 of
/// the limit was up to 3.1 times the first part, at larger loads up to 0.7 times. And where a moment is
/// imposed, that of a stick area that shrinks below a cell: the load that is missing to the limit tells the
/// radius that the stick area should have, a_s^3 = 9 (M_lim - M)/(8 mu p), p the pressure at the centre of
/// sliding (Jaeger's superposition with a smooth pressure, dH = -p ds/s); the twist grows like mu p
/// ln(1/a_s)/(2 G) there, but on a mesh no further than to a_s of about 0.6 h. Constants were set by solves
/// of the same bodies at 32 and 64 cells, 0.5 to 1 - 1e-8 of the limit. Infinite where no cell is left to
/// stick though one should.
///
/// stick: one value a cell of the whole grid; twist: of the step. In the model's units (stresses
/// over G).
Resolution resolution(const Grid& grid, const LoadStep& loads, const Eigen::ArrayXd& stick, double twist);

}  // namespace slipstick::solver
