#pragma once

#include <filesystem>
#include <string>

#include "convergence/results/result_parts.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// Options of the check of a loop. A good loop follows the exact law.
struct LoopOptions {
  double tolerance;     ///< root mean square of the load's error, over the largest load
  bool strict = false;  ///< a good loop is in the scene's units and signs, too
};

/// Judges a loop of moment against rotation, or of force against displacement, that any program computed for
/// a scene. The normal loads are those of the file, otherwise the scene's. The result has SI units;
/// result["verdict"] is good or bad, result["why"] one sentence. Throws InputError for a loop that cannot be
/// read, and for a scene whose torsion has no exact law.
Json check_loop(const solver::Scene& scene, const std::filesystem::path& file, const LoopOptions& options);

/// The result in a few lines of text.
std::string loop_text(const Json& result);

}  // namespace slipstick::convergence
