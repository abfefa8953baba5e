#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "convergence/report/scene_page.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// The number by which answers are compared, and what it is compared with.
struct Reference {
  std::string number;  ///< key in a result: twist_angle, displacement, moment, ...
  double value;        ///< its size, SI units; NaN: nothing is known
  double uncertainty;  ///< relative; 0: exact
};

/// Time and error of each method on several meshes and to several tolerances, and the choices of --accuracy:
/// {number, reference_uncertainty, points: [{method, cells, tolerance, seconds, error, status}], choices}.
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

}  // namespace slipstick::convergence
