#pragma once

#include <filesystem>
#include <vector>

#include "convergence/results/result_parts.hpp"
#include "convergence/runs/run_spec.hpp"
#include "solver/grid/grid.hpp"

namespace slipstick::convergence {

/// The paper's sphere in the state of the last map of `first_yield`, by mesh, with the errors of its stresses.
std::vector<RunSpec> stress_runs(const std::filesystem::path& scene, const std::vector<solver::Index>& cells);

/// {cells, planes, errors}: von Mises' stress and the largest shear of a solve in the planes x1-x3 and x2-x3,
/// over p0, at the points of the exact map below the surface, rows by depth from one spacing on, along the
/// negative axis; and the errors of the results of stress_runs().
Json solved_stresses(const std::filesystem::path& scene, const Json& map, const std::vector<Json>& results);

}  // namespace slipstick::convergence
