#pragma once

#include "solver/grid/reduction.hpp"
#include "solver/model/model.hpp"

namespace slipstick::solver {

/// Whether the scene may be solved on a part of its grid. Direct and dense summation serve comparisons: they
/// sum over all cells.
bool reducible(const Scene& scene);

/// Whether the pressure moves the surfaces along each other where something would hold them.
bool moves_by_pressure(const Scene& scene, const Model& model);

/// Whether the contact's translations are unknowns: not where the contact is its own image under half a turn
/// and carries no force. is_first: no step before has left tractions.
bool has_translations(const Scene& scene, const Model& model, const Eigen::ArrayXd& pressure, bool is_first);

/// The part of the grid on which tractions are found under a pressure. before: a pressure whose tractions
/// have to stay within it; empty: none.
Reduction traction_part(const Scene& scene, const Model& model, const Eigen::ArrayXd& pressure,
                        const Eigen::ArrayXd& before = {});

/// The parts of the problem that a solve leaves out, with the reasons: omissions of the scene, of
/// traction_part() and of has_translations().
std::vector<Omission> omissions(const Scene& scene, const Model& model, const Reduction& part, bool translations);

}  // namespace slipstick::solver
