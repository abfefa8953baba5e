#pragma once

#include "solver/model/model.hpp"

namespace slipstick::solver {

/// Throws InputError for a height map that cannot be used, a surface that cannot touch, an extent that is
/// missing or, as is known before the solve, too small; OutOfMemory for cells that do not fit in memory.
/// ranks: the processes that share its grid.
Model make_model(const Scene& scene, const Ranks& ranks = {});

}  // namespace slipstick::solver
