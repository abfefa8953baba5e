#pragma once

#include "solver/contact/full_coupling.hpp"
#include "solver/contact/normal_contact.hpp"
#include "solver/model/model.hpp"

namespace slipstick::solver {

/// The contact's pressure in the model's units under a step's normal load, by the scene's pressure model.
/// opening: normal displacement by shear, which adds to the gap, on the model's grid; empty: none. goal: of a
/// turn under full coupling. Throws InputError for a pressure file that does not fit the grid, holds a
/// negative value, or carries another load than the scene's.
NormalSolution find_pressure(const Scene& scene, const Model& model, const Step& step,
                             const Eigen::ArrayXd& opening = {}, const StaggeredTarget& goal = {},
                             const Progress& progress = {});

}  // namespace slipstick::solver
