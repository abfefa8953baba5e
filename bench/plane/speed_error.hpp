#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/plane/plane_design.hpp"
#include "convergence/results/result_parts.hpp"
#include "convergence/runs/progress.hpp"

/// The speed-error plane: what each choice of method, operator, model, pressure, mesh and
/// tolerance costs, and the error that it buys.
///
/// The result is docs/schema/plane.schema.json: times in seconds, errors relative, `errors` signed and of
/// each grid, `error` their root mean square, work and certificate of the first grid, which is the one timed.
namespace slipstick::bench {

using convergence::Json;

struct PlaneOptions {
  std::filesystem::path scene;   ///< the paper's, whose loads and choices are set
  std::filesystem::path output;  ///< folder of finished points, from which the same command continues
  bool quick = false;
};

/// Measures the plane, points one after the other in this process, and shows its progress. Throws InputError
/// for a scene that cannot be read or has no exact answer.
Json measure_plane(const PlaneOptions& options);

/// The points of one moment ratio (finished ones are read from the output folder) and the exact side.
Json measure_scene(const PlaneOptions& options, double moment_ratio, const std::vector<PlaneChoice>& design,
                   convergence::Progress& progress);

/// One point: errors on several grids, seconds on the first, unless the result is wrong.
Json measure_point(const std::filesystem::path& scene, double moment_ratio, const PlaneChoice& choice);

/// Envelopes and times to errors of the measured points, put into the result.
void judge_plane(Json& plane);

/// The least times to errors, for a person.
std::string times_text(const Json& plane);

}  // namespace slipstick::bench
