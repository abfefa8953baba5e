#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "convergence/result_parts.hpp"
#include "solver/scene.hpp"

namespace slipstick::convergence {

/// Judges a traction field that any program computed for a scene: against the exact solution where there is
/// one, by Coulomb's law always. twist: the one that the program reported, in rad; else the scene's, if it
/// imposes one, or the one that Coulomb's law fits best. The result has SI units; result["verdict"] is good
/// or bad, result["why"] one sentence. Throws InputError for a field or a scene that cannot be judged.
Json check_field(const solver::Scene& scene, const std::filesystem::path& file,
                 std::optional<double> twist = {});

/// The same for a person: a few lines.
std::string check_text(const Json& result);

}  // namespace slipstick::convergence
