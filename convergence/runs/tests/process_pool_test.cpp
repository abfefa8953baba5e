// Kept results are tested where a command keeps them: kept_runs_test.py.

#include "convergence/runs/process_pool.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "convergence/runs/result_cache.hpp"
#include "convergence/tests/scratch_folder.hpp"
#include "solver/tests/scene_file.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;

const std::string kPaper = std::string(SLIPSTICK_SCENES) + "/paper.toml";
const std::string kCells = "grid.cells=[16,16]";

class ProcessPoolTest : public ScratchFolder {
 protected:
  ProcessPoolOptions options() const { return {.folder = folder_ / "points", .program = SLIPSTICK_PROGRAM}; }
};

TEST_F(ProcessPoolTest, LeavesOtherChildrenOfThisProcessAlone) {
  const pid_t other = fork();
  if (other == 0) _exit(3);
  EXPECT_TRUE(ProcessPool(options()).run({{kPaper, {kCells}}}).front().is_converged());
  int status = 0;
  EXPECT_EQ(waitpid(other, &status, 0), other);
  EXPECT_EQ(WEXITSTATUS(status), 3);
}

void handle(int) {}

/// A library does not change its host's signal handlers; the host stops it by a callback.
TEST_F(ProcessPoolTest, StopsWhereItsHostSaysSo) {
  const auto before = std::signal(SIGINT, handle);
  ProcessPoolOptions stopping = options();
  static bool untouched = false;
  stopping.interrupted = [] {
    struct sigaction now {};
    sigaction(SIGINT, nullptr, &now);
    untouched = now.sa_handler == handle;
    return true;
  };
  EXPECT_THROW(ProcessPool(stopping).run({{kPaper, {"grid.cells=[256,256]", "solver.operator=direct"}}}),
               std::runtime_error);
  EXPECT_TRUE(untouched);
  std::signal(SIGINT, before);
  EXPECT_TRUE(fs::is_empty(folder_ / "points"));
}

// A cache key holds the scene's name and whole tables, which need not be UTF-8; JSON must be.
TEST_F(ProcessPoolTest, FindsResultsOfScenesWithAnyName) {
  const PreparedRun run = prepare_run({.scene = write("caf\xe9.toml", solver::kShortScene)});
  const ResultCache cache(folder_ / "runs");
  cache.keep(run.name, run.cache_key, Json{{"name", "caf\xe9"}});
  EXPECT_TRUE(cache.find(run.name, run.cache_key).has_value());
}

}  // namespace
}  // namespace slipstick::convergence
