// That a program does not outlive its parent is in study_processes_test.py.

#include "convergence/system/run_program.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <csignal>

namespace slipstick::convergence {
namespace {

using testing::HasSubstr;

TEST(RunProgram, GivesTheExitCode) {
  EXPECT_EQ(run_program({"sh", "-c", "exit 0"}).code, 0);
  EXPECT_EQ(run_program({"sh", "-c", "exit 3"}).code, 3);
  EXPECT_EQ(run_program({"sh", "-c", "kill -KILL $$"}).code, -1);
  EXPECT_EQ(run_program({"no-such-program-anywhere"}).code, -1);
}

TEST(RunProgram, SaysWhatWentWrong) {
  EXPECT_EQ(run_program({"sh", "-c", "exit 0"}).trouble, "");
  EXPECT_THAT(run_program({"sh", "-c", "exit 3"}).trouble, HasSubstr("code 3"));
  EXPECT_THAT(run_program({"sh", "-c", "kill -KILL $$"}).trouble, HasSubstr("signal 9"));
  const ProgramOptions tied{.tied_by = SLIPSTICK_PROGRAM};
  for (const ProgramOptions& options : {ProgramOptions{}, tied}) {
    const ProgramEnd end = run_program({"no-such-program-anywhere"}, options);
    EXPECT_FALSE(end.started);
    EXPECT_EQ(end.code, -1);
  }
}

TEST(RunProgram, GivesBackWhatWasWritten) {
  const std::vector<std::string> words{"sh", "-c", "echo said; echo cried >&2"};
  EXPECT_EQ(run_program(words, {.captured = Captured::output}).output, "said\n");
  EXPECT_EQ(run_program(words, {.captured = Captured::everything}).output, "said\ncried\n");
  EXPECT_EQ(run_program(words).output, "");
  const auto much = run_program({"head", "-c", "1000000", "/dev/zero"}, {.captured = Captured::output});
  EXPECT_EQ(much.output.size(), 1000000U);
}

/// No shell splits or expands arguments, with tied_by neither.
TEST(RunProgram, PassesArgumentsUnchanged) {
  const std::vector<std::string> words{"printf", "[%s]", "a b", "$HOME", "'", "--json", ""};
  for (const char* const tied_by : {"", SLIPSTICK_PROGRAM}) {
    const auto end = run_program(words, {.captured = Captured::output, .tied_by = tied_by});
    EXPECT_EQ(end.output, "[a b][$HOME]['][--json][]");
  }
}

TEST(RunProgram, TheDestructorKillsARunningProgram) {
  const auto start = std::chrono::steady_clock::now();
  { const Program left({"sleep", "600"}); }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
}

/// With SIGCHLD ignored the kernel keeps no exit status of children.
TEST(RunProgram, AnUnavailableExitStatusIsNoSuccess) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  EXPECT_EQ(run_program({"sh", "-c", "exit 0"}).code, -1);
  std::signal(SIGCHLD, before);
  EXPECT_EQ(run_program({"sh", "-c", "exit 0"}).code, 0);
}

}  // namespace
}  // namespace slipstick::convergence
