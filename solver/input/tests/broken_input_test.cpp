// Files that are none, have no end or are damaged: each is refused with its name, at once, whatever is in it.

#include <gmock/gmock.h>
#include <hdf5.h>
#include <hdf5_hl.h>

#include <cstdlib>
#include <iostream>
#include <random>

#include "solver/input/dataset_reader.hpp"
#include "solver/input/field_file.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/input_file.hpp"
#include "solver/tests/scene_file.hpp"

namespace slipstick::solver {
namespace {

namespace fs = std::filesystem;
using namespace testing;

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

TEST_F(BrokenInput, MarksAndEndingsOfOtherSystemsDoNotMatter) {
  const auto columns =
      read_columns(write("field.csv", "\xEF\xBB\xBFq1,other,x1\r\n3,word,1\r\n\r\n4,,2\r\n"), {"x1", "q1"});
  EXPECT_EQ(columns[0].values[1], 2.0);
  EXPECT_EQ(columns[1].values[0], 3.0);
}

TEST_F(BrokenInput, WholeNumbersThatNoDoubleHoldsAreNumbersToo) {
  const Scene scene = read(kShortScene, {"load.normal=9223372036854775807"});
  EXPECT_EQ(scene.steps[0].normal, 0x1p63);
  EXPECT_THAT(complaint([&] { read(kShortScene, {"grid.cells=[9223372036854775807, 8]"}); }),
              HasSubstr("grid.cells"));
}

TEST_F(BrokenInput, DatasetsAreLookedAtBeforeMemoryIsTaken) {
  const auto says = [](const fs::path& file, int rank) {
    return complaint([&] { read_datasets(file, {"height"}, rank, 100); });
  };
  EXPECT_THAT(says(dataset({3}), 2),
              AllOf(HasSubstr("dataset height"), HasSubstr("has 1 dimensions; allowed: 2")));
  EXPECT_THAT(says(dataset({2, 2, 2}), 2), HasSubstr("has 3 dimensions"));
  EXPECT_THAT(says(dataset({0}), 1), HasSubstr("0 x 1 values; allowed: from 1 to 100"));
  EXPECT_THAT(says(dataset({101}), 1), HasSubstr("101 x 1 values"));
  EXPECT_THAT(says(dataset({hsize_t{1} << 40}, 1000), 1), HasSubstr("1099511627776 x 1 values"));
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
  const auto says = [&](const char* name) { return complaint([&] { read_datasets(file, {name}, 1, 100); }); };
  EXPECT_THAT(says("text"), HasSubstr("dataset text: holds no numbers"));
  EXPECT_THAT(says("list"), HasSubstr("holds no numbers"));
  EXPECT_THAT(says("record"), HasSubstr("holds no numbers"));
  EXPECT_THAT(says("group"), HasSubstr("is no dataset"));
  EXPECT_THAT(says("link"), HasSubstr("is a link"));
  EXPECT_THAT(says("outside"), HasSubstr("has its data elsewhere"));
  EXPECT_THAT(says("none"), HasSubstr("no such dataset"));
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

TEST_F(BrokenInput, DamagedFieldsAreReadOrRefused) {
  const fs::path file = folder_ / "field.h5";
  const Grid grid{3, 2, 0.5, 0.25};
  write_fields(file, grid, {{"x1", cell_x1(grid)}, {"q1", cell_x2(grid)}}, Eigen::ArrayXd::Ones(6));
  const std::string whole = read_input_file(file, 1 << 20, "");
  std::mt19937 generator(3);
  int refused = 0;
  for (int damage = 0; damage < 100; ++damage) {
    std::string bytes = whole;
    if (damage % 10 == 0) bytes.resize(generator() % bytes.size());
    for (int flips = damage % 7; flips >= 0 && !bytes.empty(); --flips) {
      bytes[generator() % bytes.size()] = static_cast<char>(generator());
    }
    write("field.h5", bytes);
    try {
      EXPECT_EQ(read_columns(file, {"x1", "q1"}).size(), 2U);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(file.string()));
      ++refused;
    }
  }
  EXPECT_GT(refused, 10);
}

}  // namespace
}  // namespace slipstick::solver
