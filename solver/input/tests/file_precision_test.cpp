// How exactly a file gives numbers, from the digits it has.

#include "solver/input/file_precision.hpp"

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <cstdlib>

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

ArrayXd written(const ArrayXd& values, const std::string& format) {
  return values.unaryExpr([&](double x) { return std::strtod(fmt::format(fmt::runtime(format), x).c_str(), nullptr); });
}

TEST(FilePrecision, IsThatOfTheDigitsWritten) {
  const ArrayXd values = 1e8 * (ArrayXd::Random(200) + 1.1);
  EXPECT_DOUBLE_EQ(find_precision(written(values, "{:.5e}")).relative, 0.5e-5);
  EXPECT_DOUBLE_EQ(find_precision(written(values, "{:.9e}")).relative, 0.5e-9);
  EXPECT_DOUBLE_EQ(find_precision(written(1e-6 * values, "{:.3f}")).absolute, 0.5e-3);
  EXPECT_LE(find_precision(values).relative, 1.2e-16);
  EXPECT_NEAR(find_precision(values.cast<float>().cast<double>()).relative, 6e-8, 1e-9);
}

TEST(FilePrecision, BoundsWhatWritingHasChanged) {
  const ArrayXd values = 1e3 * ArrayXd::Random(200);
  for (const char* format : {"{:.4e}", "{:.2f}", "{:.0f}"}) {
    const ArrayXd read = written(values, format);
    const ArrayXd allowed = find_precision(read).rounding(read);
    EXPECT_TRUE(((read - values).abs() <= allowed * (1.0 + 1e-6)).all()) << format;
  }
}

}  // namespace
}  // namespace slipstick::solver
