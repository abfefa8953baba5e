#pragma once

#include <cstddef>

#include "solver/scene/scene.hpp"
#include "solver/solution.hpp"
#include "solver/step/tractions.hpp"

namespace slipstick::solver {

/// How well the mesh resolves a step, and the relative error that it leaves in the step's change of motion.
/// Cells of size h on a contact of radius r, h/r in the root mean square of both axes, leave these parts:
/// - everywhere 0.26 (h/r)^2, more where the pressure is Hertz's and not solved on the grid, and up to
///   0.2 h/r where the friction does not fall to zero at the edge;
/// - where the contact sticks up to its edge, the error of its area A: it turns like a bonded punch, whose
///   stiffness is 16/3 G a^3 (Reissner and Sagoci 1944), and on a thin layer, which shears evenly, grows like
///   a^4. So the relative error is 3/2 dA/A, and on layers at most 2 dA/A, with the uncertainty that
///   counted_area() states. The same at the edge of a face, whatever slips. A slip ring, whose tractions are
///   known, hides the edge: one that is s cells wide leaves 1/(1 + s^4) of it;
/// - where the friction follows another law than Coulomb's, the normal load does not fix the sum of its bounds:
///   the limit moment has the error of the counted area too, 3/2 dA/A where the bound does not fall towards
///   the edge, and up to 0.35 (h/r)^1.5 where it falls;
/// - where a moment is imposed, the error of a stick area that shrinks below a cell: the distance from
///   the limit load gives the radius that the stick area should have, a_s^3 = 9 (M_lim - M)/(8 mu p), p the
///   pressure at the centre of sliding (Jaeger's superposition with a smooth pressure, dH = -p ds/s); the
///   twist grows like mu p ln(1/a_s)/(2 G) there, but on a mesh no further than to a_s of about 0.6 h;
/// - where the load is no ratio of the mesh's own limit, what the error of that limit makes of the missing
///   load.
/// Infinite where no cell is left to stick though one should, or the mesh's limit may lie below the load.
/// Constants that are no result of theory were set by exact answers of spheres, cones, powers and punches on
/// 16 to 128 cells, on grids of any extent, at loads of 1e-6 to 1 - 1e-6 of the limit.
///
/// The error of a stick area is the uncertainty of counting it, and (stick_area) three more: a slip ring
/// within cells that stick, which follows from their tractions; the error of the contact's area where the
/// bound does not fall towards the edge; and the error of a_s by the error of the limit.
///
/// contact_area: in any unit. The rest in the model's units (stresses over G, lengths over a cell), of the whole grid.
Resolution resolution(const Scene& scene, const Step& step, const Grid& grid, const LoadStep& loads,
                      const TangentialSolution& tangential, const CountedArea& contact_area);

/// The resolution of a solution at the end of the `step`-th step: with the number that the loads up to there
/// leave open, and its uncertainty. mesh, path: see Resolution.
Resolution with_uncertainty(const Solution& solution, const Scene& scene, std::size_t step, const Quantities& mesh,
                            const Quantities& path = {});

}  // namespace slipstick::solver
