#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "solver/input/field_file.hpp"

/// Datasets of HDF5 files.
namespace slipstick::solver {

/// Rows x columns, as HDF5 has them: the values of a row are neighbours.
using Dataset = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// One or two dimensions, in the root or in the one group that has all the datasets.
inline constexpr int kTableRank = 0;

/// Reads datasets of an HDF5 file by name or path: whole or floating-point numbers in `rank` (1, 2
/// or kTableRank) dimensions, at least one value and at most `most`; one dimension makes one column. Throws
/// InputError with the file and the dataset. A file that crashes the HDF5 library ends the process: the
/// message names the file, and the exit code is 2.
std::vector<Dataset> read_datasets(const std::filesystem::path& file, const std::vector<std::string>& names, int rank,
                                   Index most);

/// A 1-D dataset of doubles or of bytes.
struct DatasetLayout {
  std::string name;
  bool is_text;
  std::size_t size;  ///< values, of all ranks
  std::size_t bytes_of_value() const { return is_text ? 1 : sizeof(double); }
};

/// A dataset that is worked out when it is written: write() puts the bytes of this rank's part, piece by piece.
using PutBytes = std::function<void(const void* bytes, std::size_t count)>;
struct LongDataset {
  DatasetLayout layout;
  std::size_t first;  ///< value with which this rank's part begins
  std::function<void(const PutBytes& put)> write;
};

/// A text under a name.
struct NamedText {
  std::string name;
  std::string text;
};

/// Writes an HDF5 file of 1-D datasets, each of its own length: numbers, and texts as their bytes. It is written as
/// write_whole_file() does, and the same content gives the same bytes. Throws InputError where it cannot be written.
void write_datasets(const std::filesystem::path& file, const std::vector<Column>& columns,
                    const std::vector<NamedText>& texts = {});
/// All ranks call it and write their parts into one file on a shared file system. If any rank cannot write,
/// the first rank throws.
void write_datasets(const std::filesystem::path& file, const std::vector<LongDataset>& datasets,
                    const Ranks& ranks = {});

/// The functions of libslipstick_hdf5. Only this module links HDF5, which needs some forty libraries.
struct Hdf5Library {
  /// As solver::read_datasets().
  decltype(read_datasets)* read;
  /// Makes a file without values; returns the offset of each dataset's values. Throws std::runtime_error.
  std::vector<off_t> (*lay_out)(const std::filesystem::path& file, const std::vector<DatasetLayout>& datasets);
};

/// Loaded by the first call. Throws InputError, which names `file`, if it cannot be loaded.
const Hdf5Library& hdf5_library(const std::filesystem::path& file);

}  // namespace slipstick::solver
