#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "convergence/report/page.hpp"
#include "convergence/report/scene_numbers.hpp"

/// Error against time of the methods, of other programs and of the two operators.
namespace slipstick::convergence {

/// Programs to compare, the numbers of the page, and the number that is compared. A program that finds only
/// the pressure is compared by approach or peak_pressure.
struct Contest {
  const std::vector<BesideMethod>& programs;
  const std::vector<PageNumber>& numbers;
  Reference reference;
};

/// Solves, on several meshes, of a scene whose files do not give its grid:
///
/// 1. to several tolerances by every method, and by the program of the scene if it has one;
/// 2. by this program and by the other programs, on coarser meshes;
/// 3. with direct sums and with convolution, on small meshes, unless another program solves the scene.
Costs costs_of(const PageScene& at, const Contest& contest, const ProcessPool& pool);

/// The costs without a page, as docs/schema/costs.schema.json. Throws as page_scene() and solve_answer(), and
/// InputError for a scene whose files give its grid.
SceneCosts scene_costs(const RunSpec& base, const PageSize& size, const std::vector<BesideMethod>& programs,
                       const std::filesystem::path& folder, const ProcessPool& pool);
/// A line for each method, mesh and tolerance.
std::string costs_text(const SceneCosts& costs);

}  // namespace slipstick::convergence
