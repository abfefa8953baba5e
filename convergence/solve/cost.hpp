#pragma once

#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// Cells along the longer side of the grid on which an application is timed.
inline constexpr solver::Index kReferenceCells = 64;

/// Seconds of one application of the scene's tangential operator on this machine, with symmetry used: the
/// unit of work in which solves on different machines can be compared. The grid has the scene's ratio of
/// sides and kReferenceCells cells along the longer side; a height map keeps its own grid.
double application_seconds(solver::Scene scene);

}  // namespace slipstick::convergence
