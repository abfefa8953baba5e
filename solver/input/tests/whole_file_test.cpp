// Other promises about files are tested where commands write them: convergence/tests/program_faults_test.py.

#include "solver/input/whole_file.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>

#include "solver/input/tests/scratch_folder.hpp"

namespace slipstick::solver {
namespace {

namespace fs = std::filesystem;

class WholeFile : public ScratchFolder {
 protected:
  std::ptrdiff_t files() const { return std::distance(fs::directory_iterator(folder_), {}); }

  fs::path file_ = folder_ / "result.json";
};

/// A reader that looks all the while sees the old text or the new one; a writer that is killed leaves either.
TEST_F(WholeFile, IsOldOrNewWheneverTheWriterIsKilled) {
  const std::string old(1 << 16, 'o');
  const std::string fresh(1 << 16, 'n');
  write_whole_file(file_, old);
  for (int trial = 0; trial < 10; ++trial) {
    const pid_t writer = fork();
    if (writer == 0) {
      for (;;) {
        write_whole_file(file_, fresh);
        write_whole_file(file_, old);
      }
    }
    for (int look = 0; look <= trial; ++look) {
      const std::string seen = file_text(file_);
      EXPECT_TRUE(seen == old || seen == fresh);
    }
    kill(writer, SIGKILL);
    waitpid(writer, nullptr, 0);
    const std::string left = file_text(file_);
    EXPECT_TRUE(left == old || left == fresh);
  }
  write_whole_file(file_, fresh);
  EXPECT_EQ(files(), 1) << "drafts of the killed are left";
}

/// The next writer reuses the draft of a killed writer, even one that is not yet waited for, and keeps off
/// the draft of a running one.
TEST_F(WholeFile, ADraftGoesWithItsWriterOnly) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  const pid_t writer = fork();
  if (writer == 0) {
    write_whole_file(file_, [&](std::FILE*) {
      if (::write(ends[1], "+", 1) == 1) pause();
    });
  }
  char begun = 0;
  EXPECT_EQ(read(ends[0], &begun, 1), 1);
  EXPECT_EQ(files(), 1);
  write_whole_file(file_, "beside");
  EXPECT_EQ(file_text(file_), "beside");
  EXPECT_EQ(files(), 2);
  kill(writer, SIGKILL);
  siginfo_t end{};
  waitid(P_PID, static_cast<id_t>(writer), &end, WEXITED | WNOWAIT);
  write_whole_file(file_, "whole");
  EXPECT_EQ(file_text(file_), "whole");
  EXPECT_EQ(files(), 1);
  waitpid(writer, nullptr, 0);
  for (const int each : ends) close(each);
}

}  // namespace
}  // namespace slipstick::solver
