#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace slipstick::solver {

/// Rows x columns, as HDF5 has them: the values of a row are neighbours.
using Dataset = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// One or two dimensions, in the root or in the one group that has all the datasets.
inline constexpr int kTableRank = 0;

/// Reads datasets of an HDF5 file by name or path: whole or floating-point numbers in `rank` (1, 2
/// or kTableRank) dimensions, at least one value and at most `most`; one dimension makes one column. Throws
/// InputError with the file and the dataset. A file that crashes the HDF5 library ends the process: the
/// message names the file, and the exit code is 2.
std::vector<Dataset> read_datasets(const std::filesystem::path& file, const std::vector<std::string>& names,
                                   int rank, Eigen::Index most);

}  // namespace slipstick::solver
