#pragma once

#include <filesystem>
#include <string>

#include "convergence/results/result_parts.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// What a loop has to be to be called good, beside following the exact law.
struct LoopOptions {
  double tolerance;     ///< root mean square of the load's error, over the largest load
  bool strict = false;  ///< in the scene's units and signs, too
};

/// Judges a loop of moment against rotation, or of force against displacement, that any program computed for
/// a scene, under the scene's normal load or those that the file gives. The result has SI units;
/// result["verdict"] is good or bad, result["why"] one sentence. Throws InputError for a loop that cannot be
/// read, and for a scene whose torsion has no exact law.
Json check_loop(const solver::Scene& scene, const std::filesystem::path& file, const LoopOptions& options);

/// The same for a person: a few lines.
std::string loop_text(const Json& result);

}  // namespace slipstick::convergence
