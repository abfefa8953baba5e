#pragma once

#include <filesystem>

#include "convergence/results/result_parts.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// What a scene is: {name, text, summary: [[words, value]], gap: {x1, along_1, x2, along_2}}, the gap in m
/// along both axes of the grid through its centre; null where the bodies cannot touch.
Json describe(const solver::Scene& scene, const std::filesystem::path& file);

}  // namespace slipstick::convergence
