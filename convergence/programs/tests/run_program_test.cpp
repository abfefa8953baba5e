#include "convergence/programs/run_program.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>

#include "convergence/programs/child_process.hpp"
#include "convergence/programs/temporary_folder.hpp"
#include "convergence/programs/tests/processes.hpp"

namespace slipstick::convergence {
namespace {

TEST(RunProgram, GivesTheExitCode) {
  EXPECT_EQ(run_program({"sh", "-c", "exit 0"}), 0);
  EXPECT_EQ(run_program({"sh", "-c", "exit 3"}), 3);
  EXPECT_EQ(run_program({"sh", "-c", "kill -KILL $$"}), -1);
  EXPECT_EQ(run_program({"no-such-program-anywhere"}), -1);
}

TEST(RunProgram, SendsOutputAndComplaintsToFiles) {
  const TemporaryFolder folder;
  EXPECT_EQ(run_program({"sh", "-c", "echo said; echo cried >&2"}, folder / "out", folder / "err"), 0);
  EXPECT_EQ(file_text(folder / "out"), "said\n");
  EXPECT_EQ(file_text(folder / "err"), "cried\n");
  EXPECT_EQ(run_program({"sh", "-c", "exit 0"}, folder / "no/such/folder"), -1);
}

/// A program that was started goes when who started it is killed.
TEST(RunProgram, DoesNotOutliveWhoStartedIt) {
#ifndef __linux__
  GTEST_SKIP() << "only Linux kills a process with its parent";
#endif
  const std::string marker = "run-program-" + std::to_string(getpid());
  for (const int signal : {SIGKILL, SIGTERM, SIGHUP}) {
    const pid_t parent = fork();
    if (parent == 0) {
      setenv(kMarker, marker.c_str(), 1);  // the program's environment, not what is seen of this process
      run_program({"sleep", "600"});
      _exit(0);
    }
    ASSERT_TRUE(comes_true([&] { return marked_processes(marker).size() == 1; }));
    kill(parent, signal);
    waitpid(parent, nullptr, 0);
    EXPECT_TRUE(comes_true([&] { return marked_processes(marker).empty(); })) << "signal " << signal;
    for (const pid_t left : marked_processes(marker)) kill(left, SIGKILL);
  }
}

/// Where nobody is told how children end, nothing is said of it.
TEST(ChildProcess, AnEndThatIsNotToldIsNoSuccess) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  EXPECT_EQ(run_program({"sh", "-c", "exit 0"}), -1);
  std::signal(SIGCHLD, before);
  EXPECT_EQ(run_program({"sh", "-c", "exit 0"}), 0);
}

}  // namespace
}  // namespace slipstick::convergence
