#include "convergence/system/run_program.hpp"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "solver/input/tests/scratch_folder.hpp"

namespace slipstick::convergence {
namespace {

using testing::HasSubstr;

/// Environment variable that identifies the processes of one test.
constexpr const char* kMarker = "SLIPSTICK_TEST_MARKER";

/// Running processes whose marker has this value; none on a system without /proc.
std::vector<pid_t> marked_processes(const std::string& value) {
  std::vector<pid_t> found;
  std::error_code error;
  const std::string assignment = std::string(kMarker) + "=" + value + '\0';
  for (const auto& entry : std::filesystem::directory_iterator("/proc", error)) {
    const pid_t process = std::atoi(entry.path().filename().c_str());
    if (process <= 0) continue;
    // The file is empty for a process that has ended and is not yet waited for.
    if (file_text(entry.path() / "environ").find(assignment) != std::string::npos) found.push_back(process);
  }
  return found;
}

/// Whether something comes true within two minutes, longer than it takes on any machine.
template <typename Condition>
bool comes_true(const Condition& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

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

/// A signal that kills the parent ends the program that it started.
TEST(RunProgram, DoesNotOutliveItsParent) {
#ifndef __linux__
  GTEST_SKIP() << "only Linux kills a process with its parent";
#endif
  const std::string marker = "run-program-" + std::to_string(getpid());
  for (const int signal : {SIGKILL, SIGTERM, SIGHUP}) {
    const pid_t parent = fork();
    if (parent == 0) {
      std::signal(signal, SIG_DFL);        // under nohup, SIGHUP is ignored
      setenv(kMarker, marker.c_str(), 1);  // /proc shows it in children, not in this process
      run_program({"sleep", "600"}, {.tied_by = SLIPSTICK_PROGRAM});
      _exit(0);
    }
    ASSERT_TRUE(comes_true([&] { return marked_processes(marker).size() == 1; }));
    kill(parent, signal);
    waitpid(parent, nullptr, 0);
    EXPECT_TRUE(comes_true([&] { return marked_processes(marker).empty(); })) << "signal " << signal;
    for (const pid_t left : marked_processes(marker)) kill(left, SIGKILL);
  }
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
