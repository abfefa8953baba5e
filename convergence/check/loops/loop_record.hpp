#pragma once

#include <filesystem>
#include <vector>

namespace slipstick::convergence {

/// Moment against rotation, or tangential force against displacement, row by row as some program wrote it, in
/// its own units.
struct LoopRecord {
  std::filesystem::path file;
  bool of_force;
  std::vector<double> time;  ///< empty: not given
  std::vector<double> load;
  std::vector<double> motion;
  std::vector<double> normal_load;  ///< empty: not given
};

/// Whether a file holds a loop, not a field: JSON, or a CSV table with a column of moments and one of
/// rotations, or forces and displacements, and none of positions.
bool is_loop_file(const std::filesystem::path& file);

/// Reads the columns moment (torque) and rotation (twist, angle, twist_angle), or else force
/// (tangential_force) and displacement, and where they are there time and normal_load, of a CSV table or from
/// lists of these names in JSON. Throws InputError for a file that cannot be read, a column or list that is
/// missing, lists of different lengths, a value that is no finite number, times that do not increase, fewer
/// than kMinLoopRows rows and a loop without motion or load.
LoopRecord read_loop(const std::filesystem::path& file);

inline constexpr std::size_t kMinLoopRows = 20;

}  // namespace slipstick::convergence
