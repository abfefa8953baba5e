#include "solver/model/make_model.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <thread>
#include <type_traits>

#include "solver/model/memory.hpp"
#include "solver/tests/paper_scene.hpp"
#include "solver/tests/scene_file.hpp"

namespace slipstick::solver {
namespace {

/// Numbers enter a model rounded to 40 bits (to_dimensionless).
constexpr double kModelRounding = 0x1p-40;

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

/// One thread takes few cells, and a quadrant has a quarter of them. A number of threads in the scene is kept.
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

}  // namespace
}  // namespace slipstick::solver
