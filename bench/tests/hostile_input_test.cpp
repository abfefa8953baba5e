// Every reader of the program against every way in which a file can be damaged: each is refused at once, with
// its name and what is allowed, by the one error that becomes exit code 2. What a fuzzer finds stands in the
// corpora beside the readers.

#include <fcntl.h>
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "analytic/pressure_table.hpp"
#include "bench/timing/timings.hpp"
#include "convergence/check/check.hpp"
#include "convergence/gates/gate_reader.hpp"
#include "convergence/gates/gate_run.hpp"
#include "convergence/hard/hard_case.hpp"
#include "convergence/loops/check_loop.hpp"
#include "convergence/loops/loop_record.hpp"
#include "convergence/programs/temporary_folder.hpp"
#include "convergence/studies/study.hpp"
#include "solver/grid/grid.hpp"
#include "solver/input/field_file.hpp"
#include "solver/input/input_error.hpp"
#include "solver/scene/scene.hpp"
#include "solver/tests/scene_file.hpp"

namespace slipstick {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

const std::vector<std::string> kColumns{"x1", "x2", "pressure", "q1", "q2"};
const std::string kGoodStudy = "scene = \"scene.toml\"\ncells = [8, 12]\n";
const std::string kGoodGates =
    "[[gate]]\nid = \"a\"\nscene = \"scene.toml\"\nquantity = \"twist_error\"\nbelow = 1.0\nbasis = \"b\"\n";
const std::string kGoodCases =
    "[[family]]\nname = \"f\"\nwhy = \"w\"\nscene = \"scene.toml\"\n[[family.vary]]\nkey = "
    "\"contact.friction\"\n"
    "values = [0.1, 0.2]\n";
const std::string kGoodHeights = "0.1,0.2,0.3\n0.2,0.1,0.2\n";
const std::string kGoodColumns = "x1,x2,pressure,q1,q2\n0,0,1e9,0,1e7\n0,1e-4,1e9,1e7,0\n1e-4,0,1e9,0,1e7\n";
const std::string kGoodResult = "{\"twist_error\": 0.5}";
const std::string kGoodTimings =
    "{\"context\": {\"num_cpus\": 2}, \"benchmarks\": [{\"name\": \"a\", \"real_time\": 1, \"cpu_time\": 1, "
    "\"time_unit\": \"ms\"}]}";

std::string good_profile() {
  std::string text = "radius,pressure\n";
  for (int i = 0; i <= 16; ++i) text += fmt::format("{},{}\n", i / 16.0, 2.0 - i / 16.0);
  return text;
}

/// The sphere's contact on 6 x 6 cells, turned.
std::string good_field() {
  constexpr double kRadius = 4.89e-4;
  std::string text = "x1,x2,pressure,q1,q2\n";
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      const double x1 = (i - 2.5) / 3.0;
      const double x2 = (j - 2.5) / 3.0;
      const double pressure = 2e9 * std::sqrt(std::max(0.0, 1.0 - x1 * x1 - x2 * x2));
      if (pressure == 0.0) continue;
      text += fmt::format("{},{},{},{},{}\n", kRadius * x1, kRadius * x2, pressure, -0.1 * pressure * x2,
                          0.1 * pressure * x1);
    }
  }
  return text;
}

/// A sphere that is twisted there and back, all of it sticking.
std::string good_loop() {
  std::string text = "time,moment,rotation\n";
  for (int i = 0; i <= 30; ++i) {
    const double twist = 1e-5 * (i <= 15 ? i : 30 - i);
    text += fmt::format("{},{},{}\n", i, 25.0 * twist, twist);
  }
  return text;
}

std::string good_json_loop() {
  std::string twists = "0";
  for (int i = 1; i <= 30; ++i) twists += fmt::format(",{}", 1e-5 * (i <= 15 ? i : 30 - i));
  return fmt::format("{{\"rotation\": [{0}], \"moment\": [{0}]}}", twists);
}

/// What reads a kind of file.
struct Reader {
  std::string file;  ///< a name, with the ending that belongs to it
  std::string good;  ///< text that it reads
  std::function<void(const fs::path&)> read;
  bool is_text = true;
  bool may_be_empty = false;  ///< the command finds that there is nothing to do
};

std::ostream& operator<<(std::ostream& out, const Reader& reader) { return out << reader.file; }

solver::Scene sphere() {
  const convergence::TemporaryFolder folder;
  const fs::path file = folder / "sphere.toml";
  std::ofstream(file) << solver::kShortScene;
  return solver::read_scene(file);
}

/// Judges a result file by a gate; that it cannot be judged is what the gate says.
void judge_result(const fs::path& file) {
  static const convergence::TemporaryFolder runs;
  static const convergence::ProcessPool pool({.folder = runs / "runs"});
  convergence::Gate gate;
  gate.id = "a";
  gate.kind = convergence::GateSource::result;
  gate.source = file;
  gate.quantity = "twist_error";
  gate.below = 1.0;
  const auto judgements = convergence::run_gates({gate}, pool);
  if (judgements.at(0).outcome == convergence::Outcome::refused) {
    throw std::invalid_argument(judgements.at(0).why);
  }
}

std::vector<Reader> readers() {
  return {{"scene.toml", solver::kShortScene, [](const auto& file) { solver::read_scene(file); }},
          {"study.toml", kGoodStudy, [](const auto& file) { convergence::read_study(file); }},
          {"gates.toml", kGoodGates, [](const auto& file) { convergence::read_gates(file); }, true, true},
          {"cases.toml", kGoodCases, [](const auto& file) { convergence::read_hard_cases(file); }},
          {"heights.csv", kGoodHeights, [](const auto& file) { solver::read_height_map(file); }},
          {"columns.csv", kGoodColumns, [](const auto& file) { solver::read_columns(file, kColumns); }},
          {"field.csv", good_field(),
           [scene = sphere()](const auto& file) { convergence::check_field(scene, file); }},
          {"loop.csv", good_loop(),
           [scene = sphere()](const auto& file) { convergence::check_loop(scene, file, {0.01}); }},
          {"loop.json", good_json_loop(), [](const auto& file) { convergence::read_loop(file); }},
          {"profile.csv", good_profile(),
           [](const auto& file) { analytic::read_tabulated_profile(file.string()); }},
          {"result.json", kGoodResult, judge_result},
          {"timings.json", kGoodTimings, [](const auto& file) { bench::read_timings(file); }},
          {"columns.h5", "", [](const auto& file) { solver::read_columns(file, kColumns); }, false}};
}

/// What a reader complains of; nothing where it does not. Anything but the error of bad input ends the test.
std::string complaint_of(const Reader& reader, const fs::path& file) {
  try {
    reader.read(file);
  } catch (const std::invalid_argument& error) {  // InputError is one, and what the exact side throws
    return error.what();
  }
  return "";
}

class HostileFile : public testing::TestWithParam<Reader> {
 protected:
  fs::path path() const { return folder_ / GetParam().file.c_str(); }
  fs::path write(const std::string& bytes) const {
    std::ofstream(path(), std::ios::binary) << bytes;
    return path();
  }
  fs::path good() const {
    if (GetParam().is_text) return write(GetParam().good);
    const Eigen::ArrayXd values = Eigen::ArrayXd::Ones(4);
    std::vector<solver::Column> columns;
    for (const std::string& name : kColumns) columns.push_back({name, values});
    solver::write_fields(path(), {2, 2, 1.0, 1.0}, columns, values);
    return path();
  }
  std::string good_bytes() const {
    std::ifstream stream(good(), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  void expect_refused(const std::string& damage) const {
    const std::string said = complaint_of(GetParam(), path());
    EXPECT_THAT(said, HasSubstr(path().string())) << damage;
    EXPECT_LT(said.size(), 4000U) << damage;
  }

  convergence::TemporaryFolder folder_;
};

TEST_P(HostileFile, ThatIsWholeIsRead) { EXPECT_EQ(complaint_of(GetParam(), good()), ""); }

TEST_P(HostileFile, ThatIsNoFileIsRefused) {
  expect_refused("missing");
  fs::create_directory(path());
  expect_refused("a folder");
  fs::remove(path());
  ASSERT_EQ(mkfifo(path().c_str(), 0600), 0);
  expect_refused("a pipe that nobody writes to");
  fs::remove(path());
  fs::create_symlink("/dev/zero", path());
  expect_refused("a device");
  fs::remove(path());
  fs::create_symlink(path(), path());
  expect_refused("a link to itself");
}

// Reading this process's memory from its first address on fails, for whoever asks.
TEST_P(HostileFile, ThatFailsWhileItIsReadIsRefused) {
  fs::create_symlink("/proc/self/mem", path());
  expect_refused("an error while reading");
}

TEST_P(HostileFile, ThatIsHugeIsRefusedUnread) {
  write("");
  fs::resize_file(path(), std::uintmax_t{1} << 36);  // takes no room on the disk
  expect_refused("64 GiB");
}

TEST_P(HostileFile, ThatHoldsSomethingElseIsRefused) {
  write("");
  if (!GetParam().may_be_empty) expect_refused("empty");
  write(
      std::string("\x7f"
                  "ELF\x02\x01\x01\0\0\0\xff\xfe\0\x01",
                  14));
  expect_refused("a program");
  write("\xff\xfe" + GetParam().good.substr(0, 20));
  expect_refused("UTF-16");
  write("caf\xe9 = 1\n");
  expect_refused("Latin-1");
  write("<!doctype html><html><body>Not found</body></html>\n");
  expect_refused("a page");
  write(std::string(200'000, '['));
  expect_refused("deep");
  write(std::string(300'000, 'a'));
  expect_refused("an endless line");
}

// A beginning may be a whole file too, as where a last line is missing.
TEST_P(HostileFile, ThatIsCutOffAnywhereIsReadOrRefused) {
  const std::string whole = good_bytes();
  const std::size_t step = GetParam().is_text ? 7 : whole.size() / 8;
  for (std::size_t size = 0; size < whole.size(); size += step) {
    write(whole.substr(0, size));
    const std::string said = complaint_of(GetParam(), path());
    EXPECT_THAT(said, AnyOf("", HasSubstr(path().string()))) << size << " bytes";
  }
}

TEST(UnreadableFile, IsRefused) {
  if (geteuid() == 0) GTEST_SKIP() << "root may read everything";
  const convergence::TemporaryFolder folder;
  for (const Reader& reader : readers()) {
    const fs::path file = folder / reader.file.c_str();
    std::ofstream(file) << reader.good;
    fs::permissions(file, fs::perms::none);
    EXPECT_THAT(complaint_of(reader, file), HasSubstr(file.string()));
  }
}

std::string name_of(const testing::TestParamInfo<Reader>& info) {
  std::string name = info.param.file;
  name[name.find('.')] = '_';
  return name;
}
INSTANTIATE_TEST_SUITE_P(Readers, HostileFile, testing::ValuesIn(readers()), name_of);

/// A text in which one thing is wrong, and what the complaint names beside the file.
struct Damage {
  std::string file;  ///< which reader
  std::string what;
  std::string text;
  std::vector<std::string> says;
};

std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return text.replace(place, from.size(), to);
}

std::vector<Damage> damages() {
  const auto scene = [](const char* what, const char* from, const char* to, std::vector<std::string> says) {
    return Damage{"scene.toml", what, with(solver::kShortScene, from, to), std::move(says)};
  };
  const auto columns = [](const char* what, const char* to, std::vector<std::string> says) {
    return Damage{"columns.csv", what, with(kGoodColumns, "0,1e-4,1e9,1e7,0", to), std::move(says)};
  };
  const auto field = [](const char* what, const std::string& row, std::vector<std::string> says) {
    return Damage{"field.csv", what, good_field() + row + "\n", std::move(says)};
  };
  return {
      scene("NaN", "0.018", "nan", {"upper.radius = nan", "positive"}),
      scene("infinite", "0.018", "inf", {"upper.radius = inf", "finite"}),
      scene("overflow", "0.018", "1e400", {":3"}),
      scene("a unit", "0.018", "\"18 mm\"", {"upper.radius = ", "18 mm", "a number"}),
      scene("negative", "0.018", "-1", {"upper.radius = -1", "positive"}),
      scene("huge grid", "[32, 32]", "[1000000, 1000000]", {"grid.cells", "1000000", "65536"}),
      scene("no grid", "[32, 32]", "[0, 8]", {"grid.cells", "whole number from 1"}),
      scene("shape of a list", "[32, 32]", "[8, 8, 8]", {"grid.cells", "two numbers"}),
      scene("unknown key", "normal", "nomral", {"load.nomral", "load.normal"}),
      scene("missing key", "normal = 1000\n", "", {"load.normal", "missing"}),
      scene("unknown word", "\"sphere\"", "\"spere\"", {"upper.shape = \"spere\"", "sphere"}),
      scene("a table for a number", "0.018", "{ a = 1 }", {"upper.radius", "a number"}),
      scene("twice", "radius = 0.018", "radius = 1\nradius = 2", {":4"}),
      {"study.toml", "NaN", kGoodStudy + "tolerances = [nan]\n", {"tolerances[0] = nan", "positive"}},
      {"study.toml", "huge", with(kGoodStudy, "12", "1000000"), {"cells[1] = 1000000", "16384"}},
      {"study.toml", "unknown key", kGoodStudy + "shift = 2\n", {"shift", "shifts"}},
      {"study.toml", "missing key", "cells = [8, 12]\n", {"scene", "missing"}},
      {"gates.toml", "NaN", with(kGoodGates, "1.0", "nan"), {"gate[0].below = nan", "finite"}},
      {"gates.toml", "unknown key", with(kGoodGates, "below", "bellow"), {"below"}},
      {"gates.toml", "a word for a table", "gate = \"a\"\n", {"gate = ", "[[gate]]"}},
      {"cases.toml", "unknown key", with(kGoodCases, "why", "whi"), {"why"}},
      {"cases.toml", "no values", with(kGoodCases, "[0.1, 0.2]", "[]"), {"values = []", "at least one"}},
      {"heights.csv", "infinite", with(kGoodHeights, "0.3", "inf"), {":1", "inf", "finite"}},
      {"heights.csv", "overflow", with(kGoodHeights, "0.3", "1e400"), {":1", "1e400", "finite"}},
      {"heights.csv", "ragged", kGoodHeights + "1,2\n", {":3", "2 values; allowed: 3"}},
      {"heights.csv", "a unit", with(kGoodHeights, "0.3", "0.3um"), {":1", "0.3um", "finite number"}},
      columns("NaN", "0,1e-4,nan,1e7,0", {":3", "nan", "finite"}),
      columns("infinite", "0,1e-4,inf,1e7,0", {":3", "inf", "finite"}),
      columns("overflow", "0,1e-4,1e400,1e7,0", {":3", "1e400", "finite"}),
      columns("ragged", "0,1e-4,1e9", {":3", "3 values; allowed: 5"}),
      columns("a unit", "0,1e-4,1 GPa,1e7,0", {":3", "1 GPa", "finite"}),
      {"columns.csv",
       "missing column",
       with(kGoodColumns, "pressure", "p"),
       {"no column pressure", "x1, x2, p"}},
      {"columns.csv", "a column twice", with(kGoodColumns, "q2", "q1"), {"two columns q1; allowed: one"}},
      field("negative", "4.075e-4,-4.075e-4,-1e9,0,1", {"row 33", "pressure = -1", "zero or positive"}),
      field("a cell twice", "8.15e-5,8.15e-5,1e9,0,1", {"row 33"}),
      field("off the grid", "8.2e-5,8e-5,1e9,0,1", {"row"}),
      field("far away", "0,1e200,1e9,0,1", {"allowed"}),
      {"loop.csv", "NaN", with(good_loop(), "1,0.00025", "1,nan"), {":3", "nan", "finite"}},
      {"loop.csv", "time that stands", with(good_loop(), "\n2,", "\n1,"), {"row 3", "time = 1", "later"}},
      {"loop.csv", "no rotation", with(good_loop(), "rotation", "height"), {"no rotation", "twist"}},
      {"loop.json", "a word", with(good_json_loop(), "[0,", "[\"a\","), {"rotation", "a list of numbers"}},
      {"loop.json", "overflow", with(good_json_loop(), "[0,", "[1e400,"), {"is not JSON"}},
      {"loop.json", "ragged", with(good_json_loop(), "[0,", "[0,0,"), {"equally many"}},
      {"profile.csv", "NaN", with(good_profile(), "0,2", "0,nan"), {":2", "nan"}},
      {"profile.csv", "infinite", with(good_profile(), "0,2", "0,inf"), {":2", "inf"}},
      {"profile.csv", "overflow", with(good_profile(), "0,2", "0,1e400"), {":2", "allowed"}},
      {"profile.csv",
       "negative",
       with(good_profile(), "0,2", "0,-2"),
       {":2", "-2", "allowed: finite and not negative"}},
      {"profile.csv", "too few", "0,1\n1,0.5\n", {"16"}},
      {"result.json", "NaN", "{\"twist_error\": NaN}", {"not JSON"}},
      {"timings.json", "a unit", with(kGoodTimings, "\"ms\"", "\"weeks\""), {"time_unit", "weeks"}},
      {"timings.json", "wrong shape", "{\"context\": {}, \"benchmarks\": 3}", {"benchmarks"}},
      {"timings.json", "no rows", "{\"context\": {}, \"benchmarks\": []}", {"benchmark"}},
  };
}

TEST(HostileText, IsRefusedWithKeyValueAndWhatIsAllowed) {
  const convergence::TemporaryFolder folder;
  const std::vector<Reader> known = readers();
  for (const Damage& damage : damages()) {
    const auto reader = std::ranges::find(known, damage.file, &Reader::file);
    ASSERT_NE(reader, known.end()) << damage.file;
    const fs::path file = folder / damage.file.c_str();
    std::ofstream(file) << damage.text;
    const std::string said = complaint_of(*reader, file);
    EXPECT_THAT(said, HasSubstr(file.string())) << damage.file << ", " << damage.what;
    for (const std::string& part : damage.says) {
      EXPECT_THAT(said, HasSubstr(part)) << damage.file << ", " << damage.what;
    }
  }
}

// A terminal obeys what stands behind an escape character.
TEST(HostileText, DoesNotReachTheTerminalAsCommands) {
  const convergence::TemporaryFolder folder;
  const fs::path file = folder / "scene.toml";
  std::ofstream(file) << with(solver::kShortScene, "\"sphere\"", "\"\\u001b]0;title\\u0007\"");
  const std::string said = complaint_of(readers().front(), file);
  EXPECT_THAT(said, AllOf(HasSubstr("\\x1b]0;title"), Not(HasSubstr("\x1b")), Not(HasSubstr("\x07"))));
}

}  // namespace
}  // namespace slipstick
