#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "solver/input/dataset_reader.hpp"

namespace slipstick::solver {

/// Where values go in a file: a 1-D dataset of doubles or of bytes.
struct DatasetLayout {
  std::string name;
  bool is_text;
  std::size_t size;
  std::size_t bytes_of_value() const { return is_text ? 1 : sizeof(double); }
  std::size_t bytes() const { return size * bytes_of_value(); }
};

/// What libslipstick_hdf5 offers: all that calls HDF5, which brings some forty libraries along.
struct Hdf5Library {
  /// As solver::read_datasets().
  decltype(read_datasets)* read;
  /// Makes a file whose values are still to be written; where those of each dataset lie. Throws
  /// std::runtime_error.
  std::vector<off_t> (*lay_out)(const std::filesystem::path& file,
                                const std::vector<DatasetLayout>& datasets);
};

/// Opened by the first call. Throws InputError, which names `file`, where it cannot be.
const Hdf5Library& hdf5_library(const std::filesystem::path& file);

}  // namespace slipstick::solver
