#pragma once

#include <filesystem>

#include "convergence/check/examination.hpp"
#include "convergence/results/result_parts.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// Whether a file holds a loop, not a field: JSON, or a CSV table without a column x1 but with columns of
/// moments and rotations, or of forces and displacements.
bool is_loop_file(const std::filesystem::path& file);

/// A loop of moment against rotation, or of force against displacement, and the exact contact under each of its normal
/// loads: the request to the package's module `loops`, which judges it. The file is a CSV table, or JSON lists of the
/// same names: moment (torque) and rotation (twist, angle, twist_angle), or force (tangential_force) and displacement;
/// optional are time and normal_load, otherwise the scene's. Throws InputError for a file that cannot be read, a
/// missing column, lists of different lengths, a value that is no finite number, times that do not increase, fewer than
/// 20 rows under a normal load, a loop without motion or load, and a scene whose torsion has no exact law. Of the
/// options strict and tolerance hold; the latter, 0.01 if it is not given, is of the root mean square of the load's
/// error over the largest load.
Json loop_request(const solver::Scene& scene, const std::filesystem::path& file, const CheckOptions& options);

}  // namespace slipstick::convergence
