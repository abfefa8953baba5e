#pragma once

#include <optional>
#include <vector>

#include "solver/grid/grid.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::solver {

/// The largest normal load of a scene's steps, N.
std::optional<double> largest_normal(const Scene& scene);

/// The scene's grid, in m. Throws InputError for an extent that is missing or too small, for cells that do
/// not match a height map, and for slender ones. effective_modulus: of a pair at least as soft as the bodies,
/// Pa.
Grid make_grid(const Scene& scene, const std::vector<Surface>& surfaces, double effective_modulus);

}  // namespace slipstick::solver
