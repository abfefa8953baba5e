#include "solver/input/whole_file.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include "solver/input/field_file.hpp"
#include "solver/input/tests/complaint.hpp"
#include "solver/input/tests/scratch_folder.hpp"

namespace slipstick::solver {
namespace {

using namespace testing;
namespace fs = std::filesystem;

/// Limits the size of files during its lifetime, as a full disk would. The test must not print meanwhile,
/// since standard output may be a file.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit small{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~SmallDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

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

TEST_F(WholeFile, KeepsItsPermissions) {
  write_whole_file(file_, "old");
  fs::permissions(file_, fs::perms::owner_read | fs::perms::owner_write);
  write_whole_file(file_, "new");
  EXPECT_EQ(fs::status(file_).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

/// A link or a device is not replaced by a plain file.
TEST_F(WholeFile, WritesThroughLinksAndToDevices) {
  const fs::path link = folder_ / "link";
  fs::create_symlink(fs::path("result.json"), link);
  write_whole_file(link, "text");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(file_text(file_), "text");
  write_whole_file("/dev/null", "text");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

/// Whatever is full or wrong: the old file stays, behind a link too, and no draft.
TEST_F(WholeFile, OfWhichOnlyAPartCanBeWrittenIsTheOldOne) {
  const fs::path link = folder_ / "link";
  write_whole_file(file_, "old");
  fs::create_symlink(file_, link);
  for (const fs::path& name : {file_, link, folder_ / "new.json"}) {
    std::string said;
    {
      const SmallDisk disk(1 << 12);
      said = complaint([&] { write_whole_file(name, std::string(1 << 20, 'n')); });
    }
    EXPECT_THAT(said, says(name.string(), "File too large", "make room"));
    EXPECT_THROW(write_whole_file(name, [](std::FILE*) { throw std::runtime_error("none to write"); }),
                 std::runtime_error);
    EXPECT_EQ(file_text(file_), "old");
    EXPECT_EQ(files(), 2);
  }
}

TEST_F(WholeFile, AFullDeviceIsSaid) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "only Linux has a full device";
  EXPECT_THAT(complaint([] { write_whole_file("/dev/full", "text"); }),
              says("/dev/full: cannot be written: No space left", "make room"));
}

TEST_F(WholeFile, MayHaveTheLongestName) {
  const fs::path longest = folder_ / std::string(255, 'n');
  write_whole_file(longest, "text");
  EXPECT_EQ(file_text(longest), "text");
  EXPECT_EQ(files(), 1);
}

TEST_F(WholeFile, WhatCannotBeWrittenIsNamed) {
  const fs::path lost = folder_ / "nowhere" / "file";
  const std::vector<std::function<void(const fs::path&)>> calls{
      [](const fs::path& file) { write_whole_file(file, "text"); }, require_place_for};
  for (const auto& call : calls) {
    EXPECT_THAT(complaint([&] { call(folder_); }),
                says(folder_.string() + ": cannot be written: Is a directory", "name a file in that folder"));
    EXPECT_THAT(complaint([&] { call(lost); }),
                says(lost.string() + ": cannot be written: No such file", "make its folder"));
  }
  EXPECT_EQ(files(), 0);
  std::ofstream(file_) << "no folder";
  EXPECT_THAT(complaint([&] { make_folder(file_ / "under"); }), HasSubstr((file_ / "under").string()));
}

/// Root may write anywhere, so that another user tries.
TEST_F(WholeFile, AReadOnlyFolderIsSaid) {
  constexpr uid_t kNobody = 65534;
  fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read |
                               fs::perms::others_exec);
  std::fflush(nullptr);  // what is not yet printed would be so twice
  const pid_t other = fork();
  if (other == 0) {
    if (geteuid() == 0 && setuid(kNobody) != 0) std::exit(77);
    const bool said =
        complaint([&] { write_whole_file(file_, "text"); }).find("Permission denied") != std::string::npos;
    const bool foreseen =
        complaint([&] { require_place_for(file_); }).find("Permission denied") != std::string::npos &&
        complaint([&] { require_writable(folder_); }).find("Permission denied") != std::string::npos;
    std::exit(said && foreseen ? 0 : 1);
  }
  int status = 0;
  waitpid(other, &status, 0);
  const int code = WEXITSTATUS(status);
  fs::permissions(folder_, fs::perms::owner_all);
  if (code == 77) GTEST_SKIP() << "root here cannot become another user";
  EXPECT_EQ(code, 0);
  EXPECT_EQ(files(), 0);
}

/// HDF5 stores the time of writing unless this is switched off.
TEST_F(WholeFile, EqualFieldsAreEqualBytes) {
  const Grid grid{4, 2, 0.5, 0.25};
  const fs::path fields = folder_ / "fields.h5";
  write_fields(fields, grid, {{"x1", cell_x1(grid)}}, Eigen::ArrayXd::Ones(8));
  const std::string before = file_text(fields);
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  write_fields(fields, grid, {{"x1", cell_x1(grid)}}, Eigen::ArrayXd::Ones(8));
  EXPECT_TRUE(file_text(fields) == before);
}

}  // namespace
}  // namespace slipstick::solver
