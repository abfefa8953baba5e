#include "bench/compare/survey.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "bench/compare/tests/made_program.hpp"
#include "convergence/programs/temporary_folder.hpp"

namespace slipstick::bench {
namespace {

using ::testing::ElementsAre;
using testing::lines_of;
using testing::made_program;

TEST(Survey, RunsWhatIsNotOnDiskYet) {
  const convergence::TemporaryFolder folder;
  const auto program = made_program(folder / "", "a", "f\\n");
  run_survey(program, {"f/cells:8"}, {}, folder / "kept");
  const auto all = run_survey(program, {"f/cells:8", "f_cells_8"}, {}, folder / "kept");
  EXPECT_THAT(lines_of(folder / "log"), ElementsAre("a ^(f/cells:8)$", "a ^(f_cells_8)$"));
  EXPECT_EQ(all["benchmarks"].size(), 4U);  // aggregates too
}

TEST(Survey, RunsAnotherProgramAndAnotherLengthAnew) {
  const convergence::TemporaryFolder folder;
  const auto program = made_program(folder / "", "a", "f\\n");
  run_survey(program, {"f"}, {.seconds = 0.1}, folder / "kept");
  run_survey(program, {"f"}, {.seconds = 0.2}, folder / "kept");
  std::filesystem::last_write_time(program,
                                   std::filesystem::last_write_time(program) + std::chrono::seconds(1));
  run_survey(program, {"f"}, {.seconds = 0.2}, folder / "kept");
  EXPECT_EQ(lines_of(folder / "log").size(), 3U);
}

}  // namespace
}  // namespace slipstick::bench
