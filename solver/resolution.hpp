#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "solver/scene/scene.hpp"
#include "solver/solution.hpp"
#include "solver/tractions.hpp"

namespace slipstick::solver {

/// How well the mesh resolves a step, and the relative error that it leaves in the step's change of motion.
/// Cells of size h on a contact of radius r, h/r in the root mean square of both axes, leave these parts:
/// - everywhere 0.26 (h/r)^2, and up to 0.22 h/r where the pressure does not fall to zero at the edge;
/// - where slip is narrower than four cells, up to 0.65 (h/r)^1.5, since tractions rise towards a staircase
/// of
///   an edge as if nothing bounded them;
/// - where the friction follows another law than Coulomb's, up to 0.45 h/r and 0.35 (h/r)^1.5, since no
/// normal
///   load fixes the sum of what friction carries;
/// - where the pressure is Hertz's and not solved on the grid, more of both; averaged over cells it also
///   widens a contact that sticks by most of a cell;
/// - where a moment is imposed, that of a stick area that shrinks below a cell: the load that is missing to
///   the limit tells the radius that the stick area should have, a_s^3 = 9 (M_lim - M)/(8 mu p), p the
///   pressure at the centre of sliding (Jaeger's superposition with a smooth pressure, dH = -p ds/s); the
///   twist grows like mu p ln(1/a_s)/(2 G) there, but on a mesh no further than to a_s of about 0.6 h;
/// - where the load is no ratio of the mesh's own limit, what the error of that limit makes of the missing
///   load.
/// Infinite where no cell is left to stick though one should, or the mesh's limit may lie below the load.
/// Constants were set by exact answers of spheres, cones, powers and punches on 16 to 96 cells at loads of
/// 1e-6 to 1 - 1e-6 of the limit.
///
/// stick: one value a cell of the whole grid. In the model's units (stresses over G, lengths over a cell).
Resolution resolution(const Scene& scene, const Step& step, const Grid& grid, const LoadStep& loads,
                      const Eigen::ArrayXd& stick);

/// Fills in which number the scene's steps up to the `step`-th leave open, and how far it may be off.
void state_uncertainty(Solution& solution, const Scene& scene, std::size_t step);

}  // namespace slipstick::solver
