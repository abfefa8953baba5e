// Files that are none, have no end or are damaged: each is refused with its name, at once, whatever is in it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <hdf5_hl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "solver/input/dataset_reader.hpp"
#include "solver/input/field_file.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/input_file.hpp"
#include "solver/input/run_apart.hpp"
#include "solver/tests/scene_file.hpp"

namespace slipstick::solver {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;

class BrokenInput : public SceneFile {
 protected:
  fs::path fifo() const {
    const fs::path file = folder_ / "fifo";
    EXPECT_EQ(mkfifo(file.c_str(), 0600), 0);
    return file;
  }
  std::string read_field(const std::string& text) const {
    const fs::path file = write("field.csv", text);
    return complaint([&] { read_columns(file, {"x1", "q1"}); });
  }
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

TEST_F(BrokenInput, OnlyRegularFilesOfAReasonableSizeAreRead) {
  const auto says = [](const fs::path& file) {
    return complaint([&] { read_input_file(file, 1000, "a letter"); });
  };
  EXPECT_THAT(says("/dev/zero"), AllOf(HasSubstr("/dev/zero"), HasSubstr("a device"), HasSubstr("a letter")));
  EXPECT_THAT(says(fifo()), AllOf(HasSubstr("fifo"), HasSubstr("a pipe")));
  EXPECT_THAT(says(folder_), HasSubstr("cannot be read: it is a folder; allowed: a letter"));
  EXPECT_THAT(says(folder_ / "none"), AllOf(HasSubstr("none: cannot be read"), HasSubstr("No such file")));
  EXPECT_THAT(says(write("long", std::string(1001, 'a'))), HasSubstr("long: is larger than"));
  EXPECT_EQ(read_input_file(write("fits", std::string(1000, 'a')), 1000, "a letter").size(), 1000U);
}

TEST_F(BrokenInput, TablesSayWhatIsWrongWithThem) {
  EXPECT_THAT(read_field(""), HasSubstr("field.csv: has no column x1; its columns: none"));
  EXPECT_THAT(read_field("x1,q1\n"), HasSubstr("holds no rows"));
  EXPECT_THAT(read_field("x1,q1,x1\n1,2,3\n"), HasSubstr("two columns x1"));
  EXPECT_THAT(read_field("x1,q1\n1,1e400\n"), AllOf(HasSubstr("field.csv:2"), HasSubstr("1e400")));
  EXPECT_THAT(read_field("x1,q1\n1,2\n1,inf\n"), AllOf(HasSubstr("field.csv:3"), HasSubstr("inf")));
  EXPECT_THAT(read_field(std::string("x1,q1\n1,2\0003\n", 13)),
              AllOf(HasSubstr("field.csv:2"), HasSubstr("\\x00")));
  EXPECT_THAT(read_field("x1,q1\n1,2,3\n"),
              AllOf(HasSubstr("field.csv:2"), HasSubstr("3 values; allowed: 2")));
  EXPECT_THAT(read_field("\xFF\xFEx\0001"), AllOf(HasSubstr("no column x1"), HasSubstr("\\xff\\xfe")));
  EXPECT_THAT(read_field("x1,q1\n" + std::string(100'000, ',')),
              HasSubstr("field.csv:2: more than 65536 values"));
}

TEST_F(BrokenInput, MessagesAreShortHoweverLongTheFileIs) {
  const std::string endless(3'000'000, 'a');
  EXPECT_LT(read_field(endless).size(), 3000U);
  EXPECT_LT(read_field("x1,q1\n1," + endless).size(), 3000U);
  EXPECT_LT(complaint([&] { read("name = \"n\"\n[upper]\nshape = \"" + endless + "\"\n"); }).size(), 3000U);
  EXPECT_LT(complaint([&] { read(endless + " = 1\n" + kShortScene); }).size(), 3000U);
}

TEST_F(BrokenInput, MarksAndEndingsOfOtherSystemsDoNotMatter) {
  const auto columns =
      read_columns(write("field.csv", "\xEF\xBB\xBFq1,other,x1\r\n3,word,1\r\n\r\n4,,2\r\n"), {"x1", "q1"});
  EXPECT_EQ(columns[0].values[1], 2.0);
  EXPECT_EQ(columns[1].values[0], 3.0);
}

TEST_F(BrokenInput, KeysAreNotEndless) {
  std::string key = "a";
  for (int i = 0; i < 32; ++i) key += " . \"a b\"";
  const auto is_refused = HasSubstr("parts");
  EXPECT_THAT(complaint([&] { read(key + " = 1\n" + kShortScene); }),
              AllOf(is_refused, HasSubstr("scene.toml:1")));
  EXPECT_THAT(complaint([&] { read(kShortScene + ("\n[" + key + "]\n")); }), is_refused);
  EXPECT_THAT(complaint([&] { read(kShortScene, {key + "=1"}); }), is_refused);
  std::string numbers = "# " + std::string(5000, '.');
  for (int i = 0; i < 100; ++i) numbers += " 0.5";
  EXPECT_EQ(read(numbers + "\n" + kShortScene).friction, 0.1);
  std::string nested = "a.a.a.a.a.a.a.a = ";
  for (int i = 0; i < 250; ++i) nested += "{ a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a = ";
  nested += "1" + std::string(250, '}') + "\n";
  EXPECT_THAT(complaint([&] { read(nested + kShortScene); }), AllOf(is_refused, HasSubstr("scene.toml:1")));
  const std::string braces = "# {{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{ a = {\n";
  EXPECT_EQ(read(braces + braces + kShortScene).friction, 0.1);
}

TEST_F(BrokenInput, WholeNumbersThatNoDoubleHoldsAreNumbersToo) {
  const Scene scene = read(kShortScene, {"load.normal=9223372036854775807"});
  EXPECT_EQ(scene.steps[0].normal, 0x1p63);
  EXPECT_THAT(complaint([&] { read(kShortScene, {"grid.cells=[9223372036854775807, 8]"}); }),
              HasSubstr("grid.cells"));
}

TEST_F(BrokenInput, HistoriesAndListsOfShapesHaveAnEnd) {
  std::string steps = kShortScene;
  for (int i = 0; i < 100'001; ++i) steps += "[[step]]\n";
  EXPECT_THAT(complaint([&] { read(steps); }),
              AllOf(HasSubstr("step = 100001 tables"), HasSubstr("at most 100000")));
  EXPECT_THAT(complaint([&] { read(kShortScene, {"cycles=100001"}); }), HasSubstr("cycles = 100001"));
  std::string shapes = kShortScene;
  shapes.replace(shapes.find("shape ="), shapes.find("young") - shapes.find("shape ="), "");
  for (int i = 0; i < 1001; ++i) shapes += "[[upper.shape]]\nshape = \"sphere\"\nradius = 1\n";
  EXPECT_THAT(complaint([&] { read(shapes); }),
              HasSubstr("upper.shape = 1001 tables: allowed: at most 1000"));
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

// The library divides by the size of a chunk that the file says: where that is zero it ends its process.
TEST_F(BrokenInput, AFileThatKillsTheLibraryIsOneThatCannotBeRead) {
  constexpr hsize_t kChunk = 0x5A17;
  const fs::path file = dataset({kChunk + 1}, kChunk);
  std::string bytes = read_input_file(file, 1 << 20, "");
  const std::string size{'\x17', '\x5A', '\0', '\0'};
  const auto place = bytes.find(size);
  ASSERT_NE(place, std::string::npos);
  bytes.replace(place, size.size(), std::string(size.size(), '\0'));
  write("file.h5", bytes);
  EXPECT_THAT(
      complaint([&] { read_datasets(file, {"height"}, 1, 1 << 20); }),
      AllOf(HasSubstr(file.string()), AnyOf(HasSubstr("does not survive"), HasSubstr("is no dataset"))));
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

TEST(RunApart, ReturnsWhatWasSent) {
  const std::string sent = run_apart(
      [](const Send& send) {
        send("ab", 2);
        send("c", 1);
      },
      100);
  EXPECT_EQ(sent, "abc");
}

TEST(RunApart, SurvivesWhateverBecomesOfTheWork) {
  EXPECT_EQ(run_apart([](const Send&) { std::raise(SIGSEGV); }, 100), "");
  EXPECT_EQ(run_apart([](const Send&) { std::abort(); }, 100), "");
  EXPECT_EQ(run_apart([](const Send&) { throw std::runtime_error("no"); }, 100), "");
  EXPECT_EQ(run_apart(
                [](const Send& send) {
                  const std::vector<char> much(std::size_t{1} << 40, 'x');
                  send(much.data(), much.size());
                },
                100),
            "");
  EXPECT_EQ(run_apart(
                [](const Send& send) {
                  for (;;) send("endless", 7);
                },
                10),
            "endlessend");
}

}  // namespace
}  // namespace slipstick::solver
