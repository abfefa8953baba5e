#pragma once

#include "solver/contact/normal_contact.hpp"
#include "solver/model/model.hpp"

namespace slipstick::solver {

/// Throws InputError (grid.extent, with what would be enough) for a pressure that the grid's edge cuts off:
/// where, on the same cells continued beyond the grid, the bodies would run into each other. Where nothing
/// does, the answer is that of any larger grid, even if the contact reaches the outermost cells. A height map
/// and a pressure file say nothing of what lies beyond: of these the outermost cells have to be free. Nothing
/// is asked where the scene says that the body ends there (upper.ends_at_grid_edge). step: whose normal load
/// the pressure carries. traction: 2*cells values that open the gap, under full coupling; empty: none do.
void require_contact_within_grid(const Scene& scene, const Model& model, const Step& step,
                                 const NormalSolution& normal, const Eigen::ArrayXd& traction = {});

/// The undeformed gap on a larger grid of the same cells about the same centre, at the level that it has on
/// the model's.
Eigen::ArrayXd continued_gap(const Scene& scene, const Model& model, const Grid& larger);

}  // namespace slipstick::solver
