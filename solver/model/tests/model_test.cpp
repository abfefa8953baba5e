#include "solver/model/make_model.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <thread>
#include <type_traits>

#include "solver/model/memory.hpp"
#include "solver/model/memory_plan.hpp"
#include "solver/step/pressure.hpp"
#include "solver/tests/paper_scene.hpp"
#include "solver/tests/scene_file.hpp"

namespace slipstick::solver {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Numbers enter a model rounded to 40 bits (to_dimensionless).
constexpr double kModelRounding = 0x1p-40;

// --- pressure files ---

class PressureFile : public SceneFile {
 protected:
  NormalSolution pressure(const std::string& table, const std::vector<std::string>& overrides = {}) const {
    const Scene scene = pressed(table, overrides);
    return find_pressure(scene, make_model(scene), scene.steps[0]);
  }
  std::string complaint_about(const std::string& rows, const std::vector<std::string>& overrides = {}) const {
    return complaint([&] { pressure("x1,x2,pressure\n" + rows, overrides); });
  }
};

TEST_F(PressureFile, IsReadToItsCells) {
  const Eigen::ArrayXd p =
      pressure("pressure,x1,x2\n2e9,-0.000125,0.000375\n1e9,0.000125,0.000125\n").pressure;
  const double unit = 210e9 / 2.6 / 2.0;
  EXPECT_NEAR(p[1 * 4 + 3] * unit / 2e9, 1.0, kModelRounding);
  EXPECT_NEAR(p[2 * 4 + 2] * unit / 1e9, 1.0, kModelRounding);
  EXPECT_EQ((p > 0.0).count(), 2);
}

TEST_F(PressureFile, MustFitTheGridAndTheLoad) {
  EXPECT_THAT(complaint_about("", {"contact.pressure_file=no.csv"}), says("no.csv", "cannot be read"));
  const std::string good = "0.000125,0.000125,1e9\n";
  EXPECT_EQ(complaint_about(good), "");
  EXPECT_EQ(complaint_about(good, {"load.normal=62.5"}), "");  // 1e9 Pa on (0.25 mm)^2
  EXPECT_THAT(complaint_about(good, {"load.normal=1000"}), says("load.normal = 1000 N", "62.5", "p.csv"));
  EXPECT_THAT(complaint_about(good + "0.000125,-0.000125,-1\n"),
              says("p.csv", "row 2", "-1", "zero or positive"));
  EXPECT_THAT(complaint_about("0.0002,0.000125,1e9\n"),
              says("p.csv", "row 1", "0.0002", "not a cell's centre"));
  EXPECT_THAT(complaint_about("0.000625,0.000125,1e9\n"), HasSubstr("not a cell's centre"));  // off the grid
  EXPECT_THAT(complaint_about("0.000125,0.000125,0\n"), HasSubstr("zero everywhere"));
  EXPECT_THAT(complaint_about("0.125,0.125,1e9\n"), HasSubstr("not a cell's centre"));  // mm for m
}

TEST_F(PressureFile, HoldsACellOnce) {
  const std::string row = "0.000125,0.000125,1e9\n";
  EXPECT_THAT(complaint_about(row + row), says("p.csv", "row 2"));
}

// --- height maps ---

class HeightMapFile : public SceneFile {
 protected:
  Model model(const std::string& heights, const std::vector<std::string>& overrides = {}) const {
    return make_model(mapped(heights, "[1e-5, 2e-5]", overrides));
  }
};

TEST_F(HeightMapFile, BringsItsGridAndItsGap) {
  const Model model = this->model("3e-6,2e-6,3e-6\n2e-6,1e-6,2e-6\n");
  EXPECT_EQ(model.grid.n1, 2);
  EXPECT_EQ(model.grid.n2, 3);
  EXPECT_DOUBLE_EQ(model.length_unit, 1e-5);
  EXPECT_DOUBLE_EQ(model.grid.h2, 2.0);
  EXPECT_EQ(model.gap.minCoeff(), 0.0);
  EXPECT_NEAR(model.gap[0], 0.2, 1e-12);
  EXPECT_EQ(model.gap[1 * 3 + 1], 0.0);
  EXPECT_NEAR(model.gap[1], 0.1, 1e-12);
}

TEST_F(HeightMapFile, SaysTheGrid) {
  EXPECT_THAT(complaint([&] { model("1,2\n3,4\n", {"grid.cells=[3, 2]"}); }),
              says("grid.cells = [3, 2]", "[2, 2]", "heights.csv"));
  EXPECT_THAT(complaint([&] { model("1,2\n3,4\n", {"grid.extent=[1, 1]"}); }),
              says("grid.extent", "upper.spacing"));
  EXPECT_EQ(complaint([&] { model("1,2\n3,4\n", {"grid.cells=[2, 2]"}); }), "");
}

TEST_F(HeightMapFile, IsRefusedWithThePlaceOfAMissingPoint) {
  for (const char* hole : {"", " ", "nan", "NaN"}) {
    EXPECT_THAT(complaint([&] { model(std::string("1,2,3\n4,") + hole + ",6\n"); }),
                says("heights.csv", "row 2, column 2", "no height", "a finite number at every point"))
        << hole;
  }
  // 4 x 3 points, 10 and 20 um apart, about the origin.
  EXPECT_THAT(complaint([&] { model("1,2,3\n4,5,6\n,8,9\n10,11,12\n"); }),
              HasSubstr("row 3, column 1 (x1 = 5e-06, x2 = -2e-05): no height"));
}

TEST_F(HeightMapFile, HasItsUnit) {
  const Model in_metres = model("3e-6,2e-6,3e-6\n2e-6,1e-6,2e-6\n");
  const Model in_micrometres = model("3,2,3\n2,1,2\n", {"upper.unit=um"});
  EXPECT_TRUE((in_micrometres.gap - in_metres.gap).abs().maxCoeff() <= kModelRounding);
}

TEST_F(HeightMapFile, HasThePointsOfTheOthers) {
  write("wide.csv", "1e-6,2e-6\n2e-6,3e-6\n");
  write("heights.csv", "3e-6,2e-6,3e-6\n2e-6,1e-6,2e-6\n");
  const auto complaint_of = [&](const std::string& file, const std::string& spacing) {
    std::string text = with_surface(
        "shape = [{shape = \"height_map\", file = \"heights.csv\", spacing = [1e-5, 2e-5]}, "
        "{shape = \"height_map\", file = \"" +
        file + "\", spacing = " + spacing + "}]\n");
    text.erase(text.find("[grid]"));
    return complaint([&] { make_model(read(text)); });
  };
  EXPECT_EQ(complaint_of("heights.csv", "[1e-5, 2e-5]"), "");
  EXPECT_THAT(complaint_of("wide.csv", "[1e-5, 2e-5]"),
              says("wide.csv", "2 x 2 heights", "allowed: 2 x 3", "heights.csv"));
  EXPECT_THAT(complaint_of("heights.csv", "[1e-5, 1e-5]"), HasSubstr("allowed: 2 x 3, 1e-05 x 2e-05 apart"));
}

// --- the model of a scene ---

/// A model's numbers equal the scene's to 12 digits only.
TEST(OverUnit, KeepsTwelveDigits) {
  for (const double value : {1.0, 0.1, 1.0 / 3.0, 6.02e23, -1.6e-19}) {
    EXPECT_LE(std::abs(to_dimensionless(value, 1.0) / value - 1.0), 0x1p-40);
    EXPECT_EQ(to_dimensionless(std::nextafter(value, 2.0 * value), 1.0), to_dimensionless(value, 1.0));
  }
  EXPECT_EQ(to_dimensionless(0.0, 3.0), 0.0);
  EXPECT_EQ(to_dimensionless(0x1.8p10, 0x1p3), 0x1.8p7);
}

TEST(Model, IsDimensionless) {
  const Model model = make_model(paper_scene(40, 0.5));
  EXPECT_EQ(model.grid.h1, 1.0);
  EXPECT_EQ(model.pair.shear_compliance, 1.0);
  EXPECT_DOUBLE_EQ(model.stress_unit, 210e9 / 2.6 / 2.0);
  ASSERT_TRUE(model.hertz);
  EXPECT_NEAR(model.hertz->semi_axis_1 * model.length_unit / paper::kContactRadius, 1.0, kModelRounding);
  EXPECT_NEAR(model.hertz->peak_pressure * model.stress_unit / paper::kPeakPressure, 1.0, kModelRounding);
  // The contact and a margin of two cells fill the grid.
  EXPECT_NEAR(40.0 * model.length_unit, 2.0 * paper::kContactRadius + 4.0 * model.length_unit, 1e-15);
}

// Law, grid and friction change their unit together: on_grid() is the only way.
static_assert(!std::is_assignable_v<LengthUnit&, double> && !std::is_assignable_v<LengthUnit&, LengthUnit>);
static_assert(!std::is_constructible_v<LengthUnit, double>);

/// One thread takes few cells, and a quadrant has a quarter of them. A number of threads in the scene is
/// kept.
TEST(Model, HasThreadsThatAreWorthTheirCells) {
  const auto threads = [](Index cells, ModelChoice choice, int asked) {
    Scene scene = paper_scene(cells, 0.5);
    scene.solver.model = choice;
    scene.solver.threads = asked;
    return make_model(scene).threads;
  };
  const int processors = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  EXPECT_EQ(threads(128, ModelChoice::full, 0), 1);
  EXPECT_EQ(threads(256, ModelChoice::full, 0), std::min(2, processors));
  EXPECT_EQ(threads(256, ModelChoice::automatic, 0), 1);
  EXPECT_EQ(threads(512, ModelChoice::automatic, 0), std::min(2, processors));
  EXPECT_EQ(threads(64, ModelChoice::automatic, 3), 3);
  EXPECT_EQ(threads(512, ModelChoice::full, 1), 1);
}

namespace fs = std::filesystem;

/// Linux's files about memory, below a folder that replaces the root.
class AvailableMemory : public SceneFile {
 protected:
  void say(const std::string& file, const std::string& text) const {
    fs::create_directories((folder_ / file).parent_path());
    write(file, text);
  }
};

TEST_F(AvailableMemory, IsUnboundedWhereNothingIsSaid) { EXPECT_EQ(available_memory(folder_), INFINITY); }

TEST_F(AvailableMemory, IsWhatTheMachineHasLeft) {
  say("proc/meminfo", "MemTotal:  16 kB\nMemFree:  2 kB\nMemAvailable:  8 kB\n");
  EXPECT_EQ(available_memory(folder_), 8.0 * 1024.0);
}

// Cached files count as used and give way. A group without a limit says "max", or a number beyond any memory.
TEST_F(AvailableMemory, IsWhatTheControlGroupsLeaveWhereThatIsLess) {
  say("proc/meminfo", "MemAvailable:  8 kB\n");
  say("proc/self/cgroup", "0::/outer/inner\n");
  say("sys/fs/cgroup/outer/inner/memory.max", "max\n");
  EXPECT_EQ(available_memory(folder_), 8192.0);
  say("sys/fs/cgroup/outer/memory.max", "6000\n");
  say("sys/fs/cgroup/outer/memory.current", "5000\n");
  EXPECT_EQ(available_memory(folder_), 1000.0);
  say("sys/fs/cgroup/outer/memory.stat", "anon 1\nfile 900\ninactive_file 700\n");
  EXPECT_EQ(available_memory(folder_), 1700.0);
  say("sys/fs/cgroup/outer/memory.current", "9000\n");
  EXPECT_EQ(available_memory(folder_), 0.0);
}

TEST_F(AvailableMemory, IsWhatControlGroupsOfTheFirstVersionLeave) {
  say("proc/meminfo", "MemAvailable:  8 kB\n");
  say("proc/self/cgroup", "3:cpu,cpuacct:/\n4:memory:/unseen\n0::/\n");
  say("sys/fs/cgroup/memory/memory.limit_in_bytes", "4096\n");
  say("sys/fs/cgroup/memory/memory.usage_in_bytes", "96\n");
  EXPECT_EQ(available_memory(folder_), 4000.0);
}

TEST_F(SceneFile, MayTakeAllOfItsMemoryLimitAndNoMore) {
  Scene scene = read(kShortScene);
  const double needed =
      predicted_memory(scene, make_model(scene), {.pressure = 0.0, .tractions = 0.0}).total();
  scene.solver.memory_limit = 1.001 * needed;
  EXPECT_EQ(make_model(scene).grid.n1, 32);
  scene.solver.memory_limit = 0.999 * needed;
  EXPECT_THAT(
      complaint([&] { make_model(scene); }),
      says("scene.toml", "grid.cells = [32, 32]", bytes_text(needed), "--memory-limit", "fewer cells"));
}

TEST_F(SceneFile, NamesNoTableThatDoesNotFitInMemory) {
  std::string text = kShortScene;
  text.replace(text.find("shape"), text.find("young") - text.find("shape"),
               "shape = \"height_map\"\nfile = \"heights.csv\"\nspacing = [1e-5, 1e-5]\n");
  Scene scene = read(text.substr(0, text.find("[grid]")));
  fs::resize_file(write("heights.csv", ""), 512U << 20);  // takes no room on the disk
  scene.solver.memory_limit = 100e6;
  EXPECT_THAT(complaint([&] { make_model(scene); }), says("heights.csv", "512 MiB", "95.4 MiB"));
}

}  // namespace
}  // namespace slipstick::solver
