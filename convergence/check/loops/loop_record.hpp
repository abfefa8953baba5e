#pragma once

#include <filesystem>
#include <vector>

namespace slipstick::convergence {

/// Moment and rotation, or tangential force and displacement, row by row in the units of the program that
/// wrote them.
struct LoopRecord {
  std::filesystem::path file;
  bool of_force;
  std::vector<double> time;  ///< empty: not given
  std::vector<double> load;
  std::vector<double> motion;
  std::vector<double> normal_load;  ///< empty: not given
};

/// Whether a file holds a loop, not a field: JSON, or a CSV table without a column x1 but with columns of
/// moments and rotations, or of forces and displacements.
bool is_loop_file(const std::filesystem::path& file);

/// Reads a CSV table, or JSON lists of the same names: moment (torque) and rotation (twist, angle,
/// twist_angle), or force (tangential_force) and displacement; optional are time and normal_load. Throws
/// InputError for a file that cannot be read, a missing column or list, lists of different lengths, a value
/// that is no finite number, times that do not increase, fewer than kMinLoopRows rows, and a loop without
/// motion or load.
LoopRecord read_loop(const std::filesystem::path& file);

/// Rows of a loop: fewer do not show its noise.
inline constexpr std::size_t kMinLoopRows = 20;

/// Consecutive rows under one normal load.
struct LoadRows {
  std::size_t from;
  std::size_t to;
  double normal_load;  ///< N
};

/// The rows under each normal load, all under the scene's load if the record names none. Throws InputError
/// for fewer than kMinLoopRows under a load.
std::vector<LoadRows> rows_by_load(const LoopRecord& loop, double scene_load);

}  // namespace slipstick::convergence
