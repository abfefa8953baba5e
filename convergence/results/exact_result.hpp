#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "convergence/oracle/oracle.hpp"
#include "convergence/results/result_parts.hpp"
#include "solver/input/field_file.hpp"
#include "solver/scene/scene.hpp"

/// The result of `solve` where a scene asks for the exact answer, solver.model = "exact": the keys of a solve
/// on a grid as far as they have a meaning without one.
namespace slipstick::convergence {

/// The scene's exact answer. Throws InputError, with the reason and what is allowed, where there is none.
Oracle require_oracle(const solver::Scene& scene);

/// Its result in SI units and radians; `seconds` is how long it took to find it. A number that does not exist
/// without a grid is null, with its reason beside it.
Json exact_result(const solver::Scene& scene, const Oracle& oracle, double seconds);

/// The same for a person: a few lines.
std::string exact_text(const Json& result);

/// Fields at the cell centres of a grid, in m.
struct GridColumns {
  solver::Grid grid;
  std::vector<solver::Column> columns;
  Eigen::ArrayXd pressure;
};

/// Pressure, tractions and stick at the cell centres of the scene's grid, with the columns of a solve on a
/// grid but its slips, which have no closed form. A cone's pressure is infinite on the axis, where an odd
/// number of cells has a centre. Throws InputError for an answer without tractions and a grid that does not
/// fit in memory.
/// ranks: the processes that share the grid.
GridColumns exact_columns(const solver::Scene& scene, const Oracle& oracle, const solver::Ranks& ranks = {});

/// Writes these, where there is pressure. Throws InputError for a file that cannot be written too.
void write_exact_fields(const std::filesystem::path& file, const solver::Scene& scene, const Oracle& oracle,
                        const solver::Ranks& ranks = {});

}  // namespace slipstick::convergence
