#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "solver/input/dataset_reader.hpp"

namespace slipstick::solver {

/// A 1-D dataset of doubles or of bytes.
struct DatasetLayout {
  std::string name;
  bool is_text;
  std::size_t size;
  std::size_t bytes_of_value() const { return is_text ? 1 : sizeof(double); }
  std::size_t bytes() const { return size * bytes_of_value(); }
};

/// The functions of libslipstick_hdf5. Only this module links HDF5, which needs some forty libraries.
struct Hdf5Library {
  /// As solver::read_datasets().
  decltype(read_datasets)* read;
  /// Makes a file without values; returns the offset of each dataset's values. Throws std::runtime_error.
  std::vector<off_t> (*lay_out)(const std::filesystem::path& file,
                                const std::vector<DatasetLayout>& datasets);
};

/// Loaded by the first call. Throws InputError, which names `file`, if it cannot be loaded.
const Hdf5Library& hdf5_library(const std::filesystem::path& file);

}  // namespace slipstick::solver
