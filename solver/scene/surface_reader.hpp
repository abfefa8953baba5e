#pragma once

#include <vector>

#include "solver/input/toml_reader.hpp"
#include "solver/scene/surface.hpp"

namespace slipstick::solver {

/// The shapes of the indenter: one by the keys of [upper], or several by tables [[upper.shape]] with the same
/// keys. Throws InputError.
std::vector<Surface> read_surfaces(SceneReader& reader);

/// How several shapes combine, upper.combine.
Combine read_combine(SceneReader& reader);

}  // namespace slipstick::solver
