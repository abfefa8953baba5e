// Any bytes are an HDF5 file with such datasets or are refused, unless they crash the HDF5 library.

#include <cstdlib>

#include "solver/input/field_file.hpp"
#include "solver/input/tests/fuzz_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace slipstick::solver;
  static const FuzzFile file("data.h5");
  const auto& path = file.write(text_of(bytes, size));
  read_or_refuse([&] {
    const auto columns = read_columns(path, {"x1", "q1"});
    const Index rows = columns.front().values.size();
    for (const Column& column : columns) {
      if (rows == 0 || column.values.size() != rows || !column.values.isFinite().all()) std::abort();
    }
  });
  read_or_refuse([&] {
    if (read_matrix(path, "height").size() == 0) std::abort();
  });
  return 0;
}
