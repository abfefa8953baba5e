#pragma once

#include "solver/contact/full_coupling.hpp"
#include "solver/contact/normal_contact.hpp"
#include "solver/model/model.hpp"

namespace slipstick::solver {

/// The contact's pressure in the model's units under a step's normal load, by the scene's pressure model.
/// opening: what opens the gap besides its shape (the normal displacement by shear), on the model's grid;
/// empty: nothing. goal: where a turn under full coupling wants less than all. progress: called now and
/// then. Throws InputError for a
/// pressure file that does not fit the grid, holds a negative value, or carries another load than the scene
/// says.
NormalSolution find_pressure(const Scene& scene, const Model& model, const Step& step,
                             const Eigen::ArrayXd& opening = {}, const StaggeredTarget& goal = {},
                             const Progress& progress = {});

}  // namespace slipstick::solver
