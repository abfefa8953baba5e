#include "solver/input/field_file.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <limits>
#include <numbers>
#include <sstream>

#include "solver/tests/scene_file.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using testing::HasSubstr;

class FieldFile : public SceneFile {
 protected:
  Grid grid_{3, 2, 0.5, 0.25};
  /// Values that lose bits where fewer than 17 digits are written.
  std::vector<Column> columns_{
      {"x1", cell_x1(grid_)},
      {"pressure",
       (ArrayXd(6) << 1.0 / 3.0, -0.1, std::numbers::pi * 1e300, std::numeric_limits<double>::denorm_min(),
        std::numeric_limits<double>::max(), 1.0 + std::numeric_limits<double>::epsilon())
           .finished()}};
};

class Format : public FieldFile, public testing::WithParamInterface<std::string> {};
INSTANTIATE_TEST_SUITE_P(Endings, Format, testing::Values(".csv", ".h5", ".hdf5"),
                         [](const auto& tested) { return tested.param.substr(1); });

TEST_P(Format, KeepsEveryBit) {
  const auto file = folder_ / ("fields" + GetParam());
  write_fields(file, grid_, columns_, ArrayXd::Ones(6));
  const auto back = read_columns(file, {"pressure", "x1"});  // by name, not by position
  ASSERT_EQ(back.size(), 2U);
  EXPECT_EQ(back[0].name, "pressure");
  EXPECT_TRUE((back[0].values == columns_[1].values).all());
  EXPECT_TRUE((back[1].values == columns_[0].values).all());
}

TEST_P(Format, HoldsOnlyTheCellsToKeep) {
  const auto file = folder_ / ("fields" + GetParam());
  write_fields(file, grid_, columns_, (ArrayXd(6) << 0, 1, 0, 0, 0.5, 1).finished());
  const auto back = read_columns(file, {"pressure"});
  ASSERT_EQ(back[0].values.size(), 3);
  EXPECT_EQ(back[0].values[0], columns_[1].values[1]);
  EXPECT_EQ(back[0].values[1], columns_[1].values[4]);
  EXPECT_EQ(back[0].values[2], columns_[1].values[5]);
}

TEST_P(Format, MayHoldNoCellButIsNotReadThen) {
  const auto file = folder_ / ("fields" + GetParam());
  write_fields(file, grid_, columns_, ArrayXd::Zero(6));
  EXPECT_TRUE(std::filesystem::exists(file));
  EXPECT_THAT(complaint([&] { read_columns(file, {"pressure"}); }), HasSubstr(file.string()));
}

TEST_P(Format, IsRefusedWhereItCannotBeWrittenOrRead) {
  const auto file = folder_ / "no such folder" / ("fields" + GetParam());
  EXPECT_THAT(complaint([&] { write_fields(file, grid_, columns_, ArrayXd::Ones(6)); }),
              testing::AllOf(HasSubstr(file.string()), HasSubstr("cannot be written")));
  EXPECT_THAT(complaint([&] { read_columns(file, {"x1"}); }),
              testing::AllOf(HasSubstr(file.string()), HasSubstr("cannot be read")));
}

TEST_P(Format, NamesAMissingColumn) {
  const auto file = folder_ / ("fields" + GetParam());
  write_fields(file, grid_, columns_, ArrayXd::Ones(6));
  EXPECT_THAT(complaint([&] {
                read_columns(file, {"x1", "q1"});
              }),
              testing::AllOf(HasSubstr(file.string()), HasSubstr("q1")));
}

TEST_P(Format, DoesNotReadNumbersThatAreNone) {
  const auto file = folder_ / ("fields" + GetParam());
  columns_[1].values[4] = std::numeric_limits<double>::quiet_NaN();
  write_fields(file, grid_, columns_, ArrayXd::Ones(6));
  EXPECT_THAT(complaint([&] { read_columns(file, {"pressure"}); }),
              testing::AllOf(HasSubstr(file.string()), HasSubstr("allowed: a finite number")));
}

/// VTK's image data has x running fastest, the grid x2: cell (i, j) must stand at j*n1 + i.
TEST_F(FieldFile, VtiHasTheGridsExtentsAndOrder) {
  const auto file = folder_ / "fields.vti";
  Column numbered{"number", ArrayXd::LinSpaced(6, 0.0, 5.0)};  // i*2 + j
  write_fields(file, grid_, {numbered, columns_[0]}, ArrayXd::Zero(6));
  const std::string text = file_text(file);
  EXPECT_THAT(text, HasSubstr("WholeExtent=\"0 3 0 2 0 0\""));
  EXPECT_THAT(text, HasSubstr("<Piece Extent=\"0 3 0 2 0 0\">"));
  EXPECT_THAT(text, HasSubstr("Origin=\"-0.75 -0.25 0\""));
  EXPECT_THAT(text, HasSubstr("Spacing=\"0.5 0.25 1\""));
  const auto start = text.find("Name=\"number\"");
  ASSERT_NE(start, std::string::npos);
  const auto first = text.find('>', start) + 1;
  std::istringstream values(text.substr(first, text.find('<', first) - first));
  for (const double expected : {0.0, 2.0, 4.0, 1.0, 3.0, 5.0}) {
    double value = -1.0;
    values >> value;
    EXPECT_EQ(value, expected);
  }
  EXPECT_THAT(text, HasSubstr("Name=\"x1\""));
  EXPECT_THAT(text, HasSubstr("</VTKFile>"));
}

TEST_F(FieldFile, OfAnUnknownEndingIsRefused) {
  for (const char* name : {"fields.txt", "fields", "fields.CSV", "fields.vtk", ".csv"}) {
    const auto file = folder_ / name;
    const std::string said = complaint([&] { write_fields(file, grid_, columns_, ArrayXd::Ones(6)); });
    EXPECT_THAT(said, testing::AllOf(HasSubstr(name), HasSubstr(".h5, .hdf5, .csv, .vti")));
    EXPECT_EQ(complaint([&] { require_field_format(file); }), said);
    EXPECT_FALSE(std::filesystem::exists(file));
  }
  for (const char* name : {"a.h5", "a.hdf5", "a.csv", "a.vti"}) EXPECT_NO_THROW(require_field_format(name));
}

TEST_F(FieldFile, CsvMayHaveSpacesQuotesAndForeignLineEnds) {
  const auto file = write("foreign.csv", "\"a\", b ,c\r\n1, 2 ,3\r\n\r\n4,5e0,-6\r\n");
  const auto back = read_columns(file, {"c", "b"});
  EXPECT_EQ(back[0].values[1], -6.0);
  EXPECT_EQ(back[1].values[0], 2.0);
}

/// A unit moves the decimal point: the value is the one that the digits say.
TEST_F(FieldFile, UnitsAndDecimalCommasKeepEveryBit) {
  const auto back = read_columns(write("comma.csv", "##\nX1 [mm];q1 (MPa)\n0,489;1,7e-3\n-0,1;nan\n"),
                                 {"q1", "x1"}, {.may_be_missing = true});
  EXPECT_EQ(back[0].values[0], 1.7e3);
  EXPECT_TRUE(std::isnan(back[0].values[1]));
  EXPECT_EQ(back[1].values[0], 0.489e-3);
  EXPECT_EQ(back[1].values[1], -1e-4);
}

TEST_F(FieldFile, WhatIsNoHdf5IsRefused) {
  const auto file = write("text.h5", "a,b\n1,2\n");
  EXPECT_THAT(complaint([&] { read_columns(file, {"a"}); }), HasSubstr("cannot be read as HDF5"));
  EXPECT_THAT(complaint([&] { read_columns(folder_, {"a"}); }), HasSubstr("cannot be read"));
}

TEST_F(FieldFile, HeightMapHasALineForEachX1) {
  const Eigen::ArrayXXd heights = read_matrix(write("heights.csv", "1,2,3\n4,5,6\n"), "height");
  ASSERT_EQ(heights.rows(), 2);
  ASSERT_EQ(heights.cols(), 3);
  EXPECT_EQ(heights(0, 2), 3.0);
  EXPECT_EQ(heights(1, 0), 4.0);
  const Eigen::ArrayXXd holes = read_matrix(write("holes.csv", "1,,3\nnan,5,6\n"), "height");
  EXPECT_TRUE(std::isnan(holes(0, 1)));
  EXPECT_TRUE(std::isnan(holes(1, 0)));
  EXPECT_EQ(holes.isNaN().count(), 2);
  EXPECT_EQ(holes(1, 2), 6.0);
  write_fields(folder_ / "flat.h5", grid_, {{"height", ArrayXd::Ones(6)}}, ArrayXd::Ones(6));
  EXPECT_THAT(complaint([&] { read_matrix(folder_ / "flat.h5", "height"); }),
              HasSubstr("has 1 dimensions; allowed: 2"));
}

}  // namespace
}  // namespace slipstick::solver
