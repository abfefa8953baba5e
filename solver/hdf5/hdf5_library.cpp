#include "solver/hdf5/hdf5_library.hpp"

#include <fmt/core.h>

#include "cmake/loaded_library.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/input_file.hpp"

namespace slipstick::solver {

const Hdf5Library& hdf5_library(const std::filesystem::path& file) {
  try {
    static const Hdf5Library& library = *loaded_library<const Hdf5Library>("slipstick_hdf5");
    return library;
  } catch (const std::runtime_error& error) {
    throw InputError(file.string(), fmt::format("HDF5 files are read and written by a library that cannot be "
                                                "opened: {}; allowed: install it, or another format",
                                                error.what()));
  }
}

std::vector<Dataset> read_datasets(const std::filesystem::path& file, const std::vector<std::string>& names,
                                   int rank, Eigen::Index most) {
  require_input_file(file, kLargestHdf5, "an HDF5 file");
  return hdf5_library(file).read(file, names, rank, most);
}

}  // namespace slipstick::solver
