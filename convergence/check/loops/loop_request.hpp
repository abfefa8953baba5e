#pragma once

#include <filesystem>

#include "convergence/results/result_parts.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// Options of the check of a loop. A good loop follows the exact law.
struct LoopOptions {
  double tolerance = 0.01;  ///< root mean square of the load's error, over the largest load
  bool strict = false;      ///< a good loop is in the scene's units and signs, too
};

/// A loop of moment against rotation, or of force against displacement, and the exact contact under each of
/// its normal loads: the request to the package's module `loops`, which judges it. The normal loads are the
/// file's, otherwise the scene's. Throws InputError for a loop that cannot be read, and for a scene whose
/// torsion has no exact law.
Json loop_request(const solver::Scene& scene, const std::filesystem::path& file, const LoopOptions& options);

}  // namespace slipstick::convergence
