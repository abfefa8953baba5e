// Any text is a table of pressures, whose states are numbers, or is refused.

#include <stdlib.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "analytic/tabulated_pressure.hpp"
#include "analytic/torsion.hpp"

namespace {

/// A file that goes when this goes.
struct TableFile {
  TableFile() : folder(std::filesystem::temp_directory_path() / "slipstick-fuzz-XXXXXX") {
    if (mkdtemp(folder.data()) == nullptr) throw std::runtime_error(folder + ": cannot be made");
  }
  ~TableFile() { std::filesystem::remove_all(folder); }
  std::string name() const { return folder + "/table.csv"; }

  std::string folder;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace slipstick::analytic;
  static const TableFile file;
  std::ofstream(file.name(), std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes), static_cast<std::streamsize>(size));
  TabulatedProfile table;
  try {
    table = read_tabulated_profile(file.name());
  } catch (const std::invalid_argument&) {
    return 0;
  }
  for (const double ratio : {0.0, 0.01, 0.5, 0.99}) {
    const TorsionState state = from_moment_ratio(ratio, *table.profile);
    const bool good = std::isfinite(state.twist) && state.stick_ratio > 0.0 && state.stick_ratio <= 1.0;
    if (!good || !std::isfinite(traction(state, 0.5, *table.profile))) std::abort();
  }
  return 0;
}
