#include "solver/input/field_file.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <numbers>
#include <sstream>

#include "solver/input/tests/complaint.hpp"
#include "solver/input/tests/scratch_folder.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

class FieldFile : public ScratchFolder {
 protected:
  Grid grid_{3, 2, 0.5, 0.25};
  /// Values that lose bits where fewer than 17 digits are written.
  std::vector<Column> columns_{
      {"x1", cell_x1(grid_)},
      {"pressure", (ArrayXd(6) << 1.0 / 3.0, -0.1, std::numbers::pi * 1e300, std::numeric_limits<double>::denorm_min(),
                    std::numeric_limits<double>::max(), 1.0 + std::numeric_limits<double>::epsilon())
                       .finished()}};
};

class Format : public FieldFile, public testing::WithParamInterface<std::string> {};
INSTANTIATE_TEST_SUITE_P(Endings, Format, testing::Values(".csv", ".h5", ".hdf5"),
                         [](const auto& tested) { return tested.param.substr(1); });

TEST_P(Format, KeepsEveryBitOfTheCellsToKeep) {
  const auto file = folder_ / ("fields" + GetParam());
  for (const ArrayXd& keep : {ArrayXd(ArrayXd::Ones(6)), ArrayXd{{0.0, 1.0, 0.0, 0.0, 0.5, 1.0}}}) {
    write_fields(file, grid_, columns_, keep);
    const auto back = read_columns(file, {"pressure", "x1"});  // by name, not by position
    ASSERT_EQ(back.size(), 2U);
    EXPECT_EQ(back[0].name, "pressure");
    for (Index cell = 0, row = 0; cell < 6; ++cell) {
      if (keep[cell] == 0.0) continue;
      ASSERT_LT(row, back[0].values.size());
      EXPECT_EQ(back[0].values[row], columns_[1].values[cell]);
      EXPECT_EQ(back[1].values[row++], columns_[0].values[cell]);
    }
    EXPECT_EQ(back[0].values.size(), (keep != 0.0).count());
  }
}

/// VTK's image data has x running fastest, the grid x2: cell (i, j) must stand at j*n1 + i.
TEST_F(FieldFile, VtiHasTheGridsExtentsAndOrder) {
  const auto file = folder_ / "fields.vti";
  Column numbered{"number", ArrayXd::LinSpaced(6, 0.0, 5.0)};  // i*2 + j
  write_fields(file, grid_, {numbered, columns_[0]}, ArrayXd::Zero(6));
  const std::string text = file_text(file);
  EXPECT_THAT(text, says("WholeExtent=\"0 3 0 2 0 0\"", "<Piece Extent=\"0 3 0 2 0 0\">", "Origin=\"-0.75 -0.25 0\"",
                         "Spacing=\"0.5 0.25 1\"", "Name=\"x1\"", "</VTKFile>"));
  const auto start = text.find("Name=\"number\"");
  ASSERT_NE(start, std::string::npos);
  const auto first = text.find('>', start) + 1;
  std::istringstream values(text.substr(first, text.find('<', first) - first));
  for (const double expected : {0.0, 2.0, 4.0, 1.0, 3.0, 5.0}) {
    double value = -1.0;
    values >> value;
    EXPECT_EQ(value, expected);
  }
}

}  // namespace
}  // namespace slipstick::solver
