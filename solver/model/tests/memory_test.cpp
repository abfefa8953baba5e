#include "solver/model/memory.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "solver/model/make_model.hpp"
#include "solver/model/memory_plan.hpp"
#include "solver/tests/scene_file.hpp"

namespace slipstick::solver {
namespace {

namespace fs = std::filesystem;
using namespace testing;

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
  EXPECT_THAT(complaint([&] { make_model(scene); }),
              AllOf(HasSubstr("scene.toml"), HasSubstr("grid.cells = [32, 32]"),
                    HasSubstr(bytes_text(needed)), HasSubstr("--memory-limit"), HasSubstr("fewer cells")));
}

TEST_F(SceneFile, NamesNoTableThatDoesNotFitInMemory) {
  std::string text = kShortScene;
  text.replace(text.find("shape"), text.find("young") - text.find("shape"),
               "shape = \"height_map\"\nfile = \"heights.csv\"\nspacing = [1e-5, 1e-5]\n");
  Scene scene = read(text.substr(0, text.find("[grid]")));
  fs::resize_file(write("heights.csv", ""), 512U << 20);  // takes no room on the disk
  scene.solver.memory_limit = 100e6;
  EXPECT_THAT(complaint([&] { make_model(scene); }),
              AllOf(HasSubstr("heights.csv"), HasSubstr("512 MiB"), HasSubstr("95.4 MiB")));
}

}  // namespace
}  // namespace slipstick::solver
