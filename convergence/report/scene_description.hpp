#pragma once

#include <filesystem>

#include "convergence/report/page.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// on_page: the scene with the cells of the page's answer.
SceneDescription describe(const solver::Scene& scene, const solver::Scene& on_page,
                          const std::filesystem::path& file);

}  // namespace slipstick::convergence
