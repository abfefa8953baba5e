// Any text is a table of numbers, a height map, or is refused; every number of a table is finite.

#include <cstdlib>

#include "solver/input/field_file.hpp"
#include "solver/input/tests/fuzz_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace slipstick::solver;
  static const FuzzFile file("table.csv");
  const auto& path = file.write(text_of(bytes, size));
  read_or_refuse([&] {
    for (const Column& column : read_columns(path, {"x1", "q1"})) {
      if (column.values.size() == 0 || !column.values.isFinite().all()) std::abort();
    }
  });
  read_or_refuse([&] {
    const Eigen::ArrayXXd heights = read_matrix(path, "height");
    if (heights.size() == 0 || heights.isInf().any()) std::abort();
  });
  return 0;
}
