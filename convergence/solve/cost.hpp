#pragma once

#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// Cells along the longer side of the grid on which applications are timed.
inline constexpr solver::Index kReferenceCells = 64;

/// Seconds of one application of the scene's tangential operator on this machine, with what its symmetry
/// leaves out, on a grid of the scene's shape and kReferenceCells cells along its longer side (a height map's
/// own grid): the unit in which the work of solves on different machines can be compared.
double application_seconds(solver::Scene scene);

}  // namespace slipstick::convergence
