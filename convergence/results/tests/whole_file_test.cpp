#include "convergence/results/whole_file.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;

class WholeFile : public testing::Test {
 protected:
  WholeFile() { fs::create_directories(folder_); }
  ~WholeFile() override { fs::remove_all(folder_); }

  static std::string text(const fs::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  std::ptrdiff_t files() const { return std::distance(fs::directory_iterator(folder_), {}); }

  /// The number of a process that is no more.
  static pid_t gone() {
    const pid_t child = fork();
    if (child == 0) _exit(0);
    waitpid(child, nullptr, 0);
    return child;
  }

  fs::path folder_ = fs::path(testing::TempDir()) / ("slipstick-whole-file-" + std::to_string(getpid()));
  fs::path file_ = folder_ / "result.json";
};

TEST_F(WholeFile, IsWrittenAndWrittenAnew) {
  write_whole_file(file_, "old");
  write_whole_file(file_, "new");
  EXPECT_EQ(text(file_), "new");
  EXPECT_EQ(files(), 1);
}

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
      const std::string seen = text(file_);
      EXPECT_TRUE(seen == old || seen == fresh);
    }
    kill(writer, SIGKILL);
    waitpid(writer, nullptr, 0);
    const std::string left = text(file_);
    EXPECT_TRUE(left == old || left == fresh);
  }
  write_whole_file(file_, fresh);
  EXPECT_EQ(files(), 1) << "drafts of the killed are left";
}

TEST_F(WholeFile, DraftsGoWithTheirWriterOnly) {
  const fs::path dead = file_.string() + ".part" + std::to_string(gone());
  const fs::path living = file_.string() + ".part" + std::to_string(getppid());
  const fs::path no_draft = file_.string() + ".part12.txt";
  for (const fs::path& other : {dead, living, no_draft}) std::ofstream(other) << "half";
  write_whole_file(file_, "whole");
  EXPECT_FALSE(fs::exists(dead));
  EXPECT_TRUE(fs::exists(living));
  EXPECT_TRUE(fs::exists(no_draft));
}

TEST_F(WholeFile, KeepsItsPermissions) {
  write_whole_file(file_, "old");
  fs::permissions(file_, fs::perms::owner_read | fs::perms::owner_write);
  write_whole_file(file_, "new");
  EXPECT_EQ(fs::status(file_).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

/// What is no plain file is not put aside for one.
TEST_F(WholeFile, WritesThroughLinksAndToDevices) {
  const fs::path link = folder_ / "link";
  fs::create_symlink(file_, link);
  write_whole_file(link, "text");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(text(file_), "text");
  write_whole_file("/dev/null", "text");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(WholeFile, WhatCannotBeWrittenIsNamed) {
  for (const fs::path& file : {folder_, folder_ / "nowhere" / "file"}) {
    try {
      write_whole_file(file, "text");
      ADD_FAILURE() << file;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(files(), 0);
}

}  // namespace
}  // namespace slipstick::convergence
