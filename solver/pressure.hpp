#pragma once

#include "solver/model.hpp"
#include "solver/normal_contact.hpp"

namespace slipstick::solver {

/// The contact's pressure in the model's units, by the scene's pressure model. Throws InputError for a
/// pressure file that does not fit the grid, holds a negative value, or carries another load than the scene
/// says.
NormalSolution find_pressure(const Scene& scene, const Model& model);

}  // namespace slipstick::solver
