#pragma once

#include "bench/plane/speed_error.hpp"
#include "convergence/solve/measured_accuracy.hpp"

namespace slipstick::bench {

/// The data from which `solve --accuracy` picks, made of the plane's points with the default choices: on each
/// mesh the largest error over the loads, the loosest tolerance that changes no load's error by more than a
/// tenth of it, and the work. A mesh that was not solved at every load, or to one tolerance only where finer
/// meshes have several, gets the tolerance of the next coarser mesh. Throws std::runtime_error for a plane
/// without two such meshes.
convergence::AccuracyData accuracy_from_plane(const Json& plane);

}  // namespace slipstick::bench
