#include "solver/input/field_file.hpp"

#include <gmock/gmock.h>
#include <hdf5.h>
#include <hdf5_hl.h>

#include <cstdlib>
#include <iostream>
#include <limits>
#include <numbers>
#include <sstream>

#include "solver/input/datasets.hpp"
#include "solver/input/input_file.hpp"
#include "solver/tests/scene_file.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using testing::HasSubstr;
namespace fs = std::filesystem;

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

TEST_P(Format, IsRefusedWithItsName) {
  const auto file = folder_ / ("fields" + GetParam());
  const auto refusal = [&](const std::vector<std::string>& names) {
    return complaint([&] { read_columns(file, names); });
  };
  EXPECT_THAT(refusal({"x1"}), says(file.string(), "cannot be read"));
  write_fields(file, grid_, columns_, ArrayXd::Zero(6));  // may hold no cell, but is not read then
  EXPECT_TRUE(fs::exists(file));
  EXPECT_THAT(refusal({"pressure"}), HasSubstr(file.string()));
  columns_[1].values[4] = std::numeric_limits<double>::quiet_NaN();
  write_fields(file, grid_, columns_, ArrayXd::Ones(6));
  EXPECT_THAT(refusal({"x1", "q1"}), says(file.string(), "q1"));
  EXPECT_THAT(refusal({"pressure"}), says(file.string(), "allowed: a finite number"));
  const auto lost = folder_ / "no such folder" / ("fields" + GetParam());
  EXPECT_THAT(complaint([&] { write_fields(lost, grid_, columns_, ArrayXd::Ones(6)); }),
              says(lost.string(), "cannot be written"));
}

/// VTK's image data has x running fastest, the grid x2: cell (i, j) must stand at j*n1 + i.
TEST_F(FieldFile, VtiHasTheGridsExtentsAndOrder) {
  const auto file = folder_ / "fields.vti";
  Column numbered{"number", ArrayXd::LinSpaced(6, 0.0, 5.0)};  // i*2 + j
  write_fields(file, grid_, {numbered, columns_[0]}, ArrayXd::Zero(6));
  const std::string text = file_text(file);
  EXPECT_THAT(text, says("WholeExtent=\"0 3 0 2 0 0\"", "<Piece Extent=\"0 3 0 2 0 0\">",
                         "Origin=\"-0.75 -0.25 0\"", "Spacing=\"0.5 0.25 1\"", "Name=\"x1\"", "</VTKFile>"));
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

TEST_F(FieldFile, OfAnUnknownEndingIsRefused) {
  for (const char* name : {"fields.txt", "fields", "fields.CSV", "fields.vtk", ".csv"}) {
    const auto file = folder_ / name;
    const std::string said = complaint([&] { write_fields(file, grid_, columns_, ArrayXd::Ones(6)); });
    EXPECT_THAT(said, says(name, ".h5, .hdf5, .csv, .vti"));
    EXPECT_EQ(complaint([&] { require_field_format(file); }), said);
    EXPECT_FALSE(std::filesystem::exists(file));
  }
  for (const char* name : {"a.h5", "a.hdf5", "a.csv", "a.vti"}) EXPECT_NO_THROW(require_field_format(name));
}

TEST_F(FieldFile, CsvMayHaveMarksSpacesQuotesAndForeignLineEnds) {
  const auto file = write("foreign.csv", "\xEF\xBB\xBF\"a\", b ,c\r\n1, 2 ,3\r\n\r\n4,5e0,-6\r\n");
  const auto back = read_columns(file, {"c", "b", "a"});
  EXPECT_EQ(back[0].values[1], -6.0);
  EXPECT_EQ(back[1].values[0], 2.0);
  EXPECT_EQ(back[2].values[1], 4.0);
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

class BrokenInput : public SceneFile {
 protected:
  /// A file of one dataset "height" of whole numbers.
  fs::path dataset(const std::vector<hsize_t>& size, hsize_t chunk = 0) const {
    fs::path file = folder_ / "file.h5";
    const hid_t id = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t space = H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr);
    const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
    if (chunk > 0) H5Pset_chunk(how, 1, &chunk);
    const hid_t set = H5Dcreate2(id, "height", H5T_NATIVE_INT, space, H5P_DEFAULT, how, H5P_DEFAULT);
    EXPECT_GE(set, 0);
    H5Dclose(set);
    H5Pclose(how);
    H5Sclose(space);
    H5Fclose(id);
    return file;
  }
};

TEST_F(BrokenInput, WholeNumbersThatNoDoubleHoldsAreNumbersToo) {
  const Scene scene = read(kShortScene, {"load.normal=9223372036854775807"});
  EXPECT_EQ(scene.steps[0].normal, 0x1p63);
  EXPECT_THAT(complaint([&] { read(kShortScene, {"grid.cells=[9223372036854775807, 8]"}); }),
              HasSubstr("grid.cells"));
}

TEST_F(BrokenInput, DatasetsAreLookedAtBeforeMemoryIsTaken) {
  const auto said = [](const fs::path& file, int rank) {
    return complaint([&] { read_datasets(file, {"height"}, rank, 100); });
  };
  EXPECT_THAT(said(dataset({3}), 2), says("dataset height", "has 1 dimensions; allowed: 2"));
  EXPECT_THAT(said(dataset({2, 2, 2}), 2), HasSubstr("has 3 dimensions"));
  EXPECT_THAT(said(dataset({0}), 1), HasSubstr("0 x 1 values; allowed: from 1 to 100"));
  EXPECT_THAT(said(dataset({101}), 1), HasSubstr("101 x 1 values"));
  EXPECT_THAT(said(dataset({hsize_t{1} << 40}, 1000), 1), HasSubstr("1099511627776 x 1 values"));
}

TEST_F(BrokenInput, OnlyNumbersOfTheFileItselfAreRead) {
  const fs::path file = folder_ / "types.h5";
  const hid_t id = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  H5LTmake_dataset_string(id, "text", "height");
  const hsize_t one = 1;
  const hid_t space = H5Screate_simple(1, &one, nullptr);
  const hid_t list = H5Tvlen_create(H5T_NATIVE_DOUBLE);
  H5Dclose(H5Dcreate2(id, "list", list, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  const hid_t record = H5Tcreate(H5T_COMPOUND, 8);
  H5Tinsert(record, "a", 0, H5T_NATIVE_DOUBLE);
  H5Dclose(H5Dcreate2(id, "record", record, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  H5Gclose(H5Gcreate2(id, "group", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  H5Lcreate_external("/etc/hostname", "/x", id, "link", H5P_DEFAULT, H5P_DEFAULT);
  const hid_t outside = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_external(outside, "/dev/zero", 0, H5F_UNLIMITED);
  H5Dclose(H5Dcreate2(id, "outside", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, outside, H5P_DEFAULT));
  H5Pclose(outside);
  H5Tclose(record);
  H5Tclose(list);
  H5Sclose(space);
  H5Fclose(id);
  for (const auto& [name, said] : {std::pair{"text", "dataset text: holds no numbers"},
                                   {"list", "holds no numbers"},
                                   {"record", "holds no numbers"},
                                   {"group", "is no dataset"},
                                   {"link", "is a link"},
                                   {"outside", "has its data elsewhere"},
                                   {"none", "no such dataset"}}) {
    EXPECT_THAT(complaint([&] { read_datasets(file, {name}, 1, 100); }), HasSubstr(said));
  }
}

// The library divides by the size of a chunk that the file says: a zero there ends the process. Newer
// versions of the library refuse the file.
TEST_F(BrokenInput, AFileThatCrashesTheLibraryIsNamed) {
  constexpr hsize_t kChunk = 0x5A17;
  const fs::path file = dataset({kChunk + 1}, kChunk);
  std::string bytes = read_input_file(file, 1 << 20, "");
  const std::string size{'\x17', '\x5A', '\0', '\0'};
  const auto place = bytes.find(size);
  ASSERT_NE(place, std::string::npos);
  bytes.replace(place, size.size(), std::string(size.size(), '\0'));
  write("file.h5", bytes);
  const auto read_and_end = [&] {
    std::cerr << complaint([&] { read_datasets(file, {"height"}, 1, 1 << 20); });
    std::exit(2);
  };
  EXPECT_EXIT(read_and_end(), testing::ExitedWithCode(2), "file.h5: .*(does not survive|is no dataset)");
}

}  // namespace
}  // namespace slipstick::solver
