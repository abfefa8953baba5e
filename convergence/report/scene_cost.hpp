#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "convergence/report/scene_numbers.hpp"
#include "convergence/report/scene_page.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// Time and error of each method on several meshes and to several tolerances, and the choices of --accuracy:
/// {number, reference_uncertainty, points: [{method, cells, tolerance, seconds, error, status}], choices}. An
/// error is the distance from the reference and the reference's own uncertainty.
/// A scene's program counts as a method, beside this program's own.
Json error_against_time(const RunSpec& base, const solver::Scene& scene,
                        const std::vector<solver::Index>& meshes, const Reference& reference,
                        const PageSize& size, const ProcessPool& pool);

/// Other programs, and by which numbers their answers are compared: the rows of a page's numbers, of which
/// the one named first, or of a program that finds the pressure alone the approach or the highest pressure.
struct Beside {
  const std::vector<BesideMethod>& programs;
  const Json& numbers;
  std::string number;
};

/// The answers of this program and of others on some meshes, a row each: {name, version, cells, status,
/// message, seconds, cpu_seconds, number, error}.
Json answers_beside(const RunSpec& base, const solver::Scene& scene, const std::vector<solver::Index>& meshes,
                    const Beside& beside, const ProcessPool& pool);

/// Whole solves by direct sums and by convolution on small meshes of the scene, and the cells along the
/// longer side from which on convolution is quicker: {rows: [{operator, cells, seconds, low, high}], cells,
/// low, high, remark}.
Json direct_against_dcfft(const RunSpec& base, const solver::Scene& scene, const PageSize& size,
                          const ProcessPool& pool);

/// The times alone: {provenance, scene, numbers, cost, operators, programs}; docs/schema/costs.schema.json.
/// Throws as scene_page(), and InputError for a scene whose files have its grid.
Json scene_costs(const PageRequest& request, const std::filesystem::path& folder, const ProcessPool& pool);
/// The same for a person: a line for each method, mesh and tolerance.
std::string costs_text(const Json& costs);

}  // namespace slipstick::convergence
