#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "convergence/report/page.hpp"
#include "convergence/report/scene_numbers.hpp"
#include "convergence/report/scene_page.hpp"
#include "solver/scene/scene.hpp"

/// Error against time of the methods, of other programs and of the two operators.
namespace slipstick::convergence {

/// Every method, and the program of the scene if it has one, on several meshes and to several tolerances.
Cost error_against_time(const RunSpec& base, const solver::Scene& scene,
                        const std::vector<solver::Index>& meshes, const Reference& reference,
                        const PageSize& size, const ProcessPool& pool);

/// Programs to compare, and the number that is compared. A program that finds only the pressure is compared
/// by approach or peak_pressure.
struct Contest {
  const std::vector<BesideMethod>& programs;
  const std::vector<PageNumber>& numbers;
  std::string number;
};

/// The answers of this program and of others on some meshes.
std::vector<PageProgram> answers_of_programs(const RunSpec& base, const solver::Scene& scene,
                                             const std::vector<solver::Index>& meshes, const Contest& contest,
                                             const ProcessPool& pool);

/// Whole solves with direct sums and with convolution on small meshes of the scene.
OperatorTimes direct_against_dcfft(const RunSpec& base, const solver::Scene& scene, const PageSize& size,
                                   const ProcessPool& pool);

/// The costs without a page, as docs/schema/costs.schema.json. Throws as scene_page(), and InputError for a
/// scene whose files give its grid.
SceneCosts scene_costs(const PageRequest& request, const std::filesystem::path& folder,
                       const ProcessPool& pool);
/// A line for each method, mesh and tolerance.
std::string costs_text(const SceneCosts& costs);

}  // namespace slipstick::convergence
