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

/// Throws InputError (grid.extent, with one that holds the cells where the contact goes on, up to twice the grid's) for
/// a pressure that the grid's edge cuts off: on the same cells continued beyond the grid, the bodies would overlap.
/// Where they do not, the answer is the same on any larger grid, even if the contact reaches the outermost cells. A
/// height map and a pressure file do not define the surroundings of the grid: under these the outermost cells have to
/// be free. Bodies that end at the grid's edge (upper.ends_at_grid_edge) are not checked. step: gives the normal load
/// of the pressure. traction: 2*cells values that open the gap, under full coupling; empty: none.
void require_contact_within_grid(const Scene& scene, const Model& model, const Step& step, const NormalSolution& normal,
                                 const Eigen::ArrayXd& traction = {});

}  // namespace slipstick::solver
