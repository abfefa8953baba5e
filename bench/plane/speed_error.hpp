#pragma once

#include <filesystem>

#include "convergence/results/result_parts.hpp"
#include "convergence/runs/progress.hpp"

/// The points of the speed-error plane: what each choice of method, operator, model, pressure, mesh and tolerance
/// costs, and the error that it buys. The Python package (slipstick.speed.plane) designs and judges it.
///
/// The result, judged, is docs/schema/plane.schema.json; before, `seconds` has each repetition. Errors are
/// relative, `errors` signed and of each grid, `error` their root mean square, work and certificate of the
/// first grid, which is the one timed.
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

/// The points of one load of the design (finished ones are read from the output folder) and the exact side.
Json measure_load(const PlaneOptions& options, const Json& load, convergence::Progress& progress);

/// One point: errors on several grids, seconds on the first, unless the result is wrong. run: of the design,
/// with its choice, grids (whose edges lie differently in the cells), overrides of the scene, file and label.
Json measure_point(const std::filesystem::path& scene, const Json& run);

}  // namespace slipstick::bench
