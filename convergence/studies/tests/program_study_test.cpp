// `slipstick study` as users run it: interrupted, continued, and with bad input.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "convergence/programs/tests/processes.hpp"

namespace {

using nlohmann::json;
using testing::HasSubstr;
namespace fs = std::filesystem;

class ProgramStudy : public testing::Test {
 protected:
  ProgramStudy() {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "study.toml")
        << "scene = \"" << SLIPSTICK_SCENES << "/paper.toml\"\ncells = [16, 24, 32, 48, 64, 96, 128]\n"
        << "shifts = 2\nquantities = [\"twist_error\"]\n";
  }
  ~ProgramStudy() override { fs::remove_all(folder_); }

  /// Starts the study with its result and its messages in files of a name, as many solves at a time as jobs
  /// says; its processes are marked with the folder.
  pid_t start(const std::string& name, const std::string& jobs = "0") const {
    const pid_t child = fork();
    if (child > 0) return child;
    setpgid(0, 0);  // so that an interrupt reaches its processes, as from a terminal, and not this one
    setenv(slipstick::kMarker, folder_.c_str(), 1);
    std::freopen((folder_ / (name + ".log")).c_str(), "w", stderr);
    std::freopen((folder_ / (name + ".txt")).c_str(), "w", stdout);
    const std::string study = folder_ / "study.toml";
    const std::string points = folder_ / "points";
    const std::string result = folder_ / (name + ".json");
    execl(SLIPSTICK_PROGRAM, "slipstick", "study", study.c_str(), "--output", points.c_str(), "--json",
          result.c_str(), "--jobs", jobs.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }

  static int exit_code(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  std::string text(const std::string& file) const { return slipstick::file_text(folder_ / file); }

  /// Those that run, the study's own and its workers'.
  std::vector<pid_t> processes() const { return slipstick::marked_processes(folder_); }

  std::vector<fs::path> finished() const {
    std::vector<fs::path> files;
    if (!fs::exists(folder_ / "points")) return files;
    for (const auto& entry : fs::directory_iterator(folder_ / "points")) {
      if (entry.path().extension() == ".json") files.push_back(entry.path());
    }
    return files;
  }

  struct ProcessState {
    char state = 'X';  ///< that of one that is gone
    pid_t parent = 0;
  };
  static ProcessState state_of(pid_t process) {
    ProcessState found;
    const std::string stat = slipstick::file_text("/proc/" + std::to_string(process) + "/stat");
    if (!stat.empty()) std::istringstream(stat.substr(stat.rfind(')') + 1)) >> found.state >> found.parent;
    return found;
  }

  /// Kills the only worker of a study in the middle of a run, once so many others are finished.
  bool killed_after(std::size_t runs, pid_t study) const {
    // A worker that computes whenever one looks, so long after its last run, is not between two runs.
    constexpr int kLooks = 15;
    const std::size_t kept = finished().size();
    pid_t worker = 0;
    for (int look = 0; look < kLooks; ++look) {
      for (const pid_t process : processes()) {
        // A worker is the study's child; children of its own are those of a sanitizer that looks for leaks.
        if (state_of(process).parent == study) worker = process;
      }
      if (worker == 0 || kept < runs || finished().size() != kept || state_of(worker).state != 'R')
        return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    kill(worker, SIGSTOP);
    const auto state = [&] { return state_of(worker).state; };
    while (state() != 'T' && state() != 'Z' && state() != 'X') std::this_thread::yield();
    const bool in_a_run = finished().size() == kept;
    kill(worker, in_a_run ? SIGKILL : SIGCONT);
    return in_a_run;
  }

  fs::path folder_ = fs::path(testing::TempDir()) / ("slipstick-program-study-" + std::to_string(getpid()));
};

/// What an interrupt leaves is whole, and the same command goes on from it to the same result.
TEST_F(ProgramStudy, GoesOnAfterAnInterrupt) {
  const pid_t first = start("first");
  while (finished().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  kill(-first, SIGINT);
  ASSERT_EQ(exit_code(first), 2) << text("first.log");
  EXPECT_THAT(text("first.log"), HasSubstr("the same command goes on from there"));
  const std::vector<fs::path> left = finished();
  std::vector<fs::file_time_type> written;
  for (const fs::path& file : left) {
    std::ifstream stream(file);
    EXPECT_TRUE(json::parse(stream, nullptr, false).is_object()) << file;
    written.push_back(fs::last_write_time(file));
  }

  ASSERT_EQ(exit_code(start("second")), 0) << text("second.log");
  EXPECT_GT(finished().size(), left.size());
  for (std::size_t i = 0; i < left.size(); ++i)
    EXPECT_EQ(fs::last_write_time(left[i]), written[i]) << left[i];
  fs::remove_all(folder_ / "points");
  ASSERT_EQ(exit_code(start("third")), 0) << text("third.log");
  const auto orders = [&](const std::string& name) {
    return json::parse(text(name + ".json"))["series"]["paper"]["order"];
  };
  EXPECT_EQ(orders("second"), orders("third"));
}

/// Whichever worker is killed: the study says so, in its text and its result, and leaves with 1. What is not
/// known is null with a reason and not zero.
TEST_F(ProgramStudy, AKilledWorkerIsNamedAndTheOthersAreJudged) {
#ifndef __linux__
  GTEST_SKIP() << "only Linux shows which processes are the study's";
#endif
  std::ofstream(folder_ / "study.toml")
      << "scene = \"" << SLIPSTICK_SCENES << "/paper.toml\"\ncells = [256, 320]\n"
      << "quantities = [\"twist_error\"]\n";
  // One at a time, the larger mesh first: the solve itself, to a tighter tolerance, then those of the other.
  for (const std::size_t before : {0U, 1U, 2U, 4U}) {
    const std::string name = "killed-" + std::to_string(before);
    fs::remove_all(folder_ / "points");
    const pid_t study = start(name, "1");
    ASSERT_TRUE(slipstick::comes_true([&] { return killed_after(before, study); })) << text(name + ".log");
    EXPECT_EQ(exit_code(study), 1) << text(name + ".log");
    const json result = json::parse(text(name + ".json"));
    EXPECT_EQ(result["failed_runs"]["count"], 1);
    EXPECT_THAT(result["failed_runs"]["first"]["message"].get<std::string>(),
                HasSubstr("killed by signal 9"));
    EXPECT_THAT(text(name + ".txt"), testing::AllOf(HasSubstr(" runs failed; the first (paper, grid.cells="),
                                                    HasSubstr("killed by signal 9")));
    EXPECT_THAT(text(name + ".log"), HasSubstr("killed by signal 9"));
    const json& series = result["series"]["paper"];
    EXPECT_THAT(series["order"]["twist_error"]["why"].get<std::string>(), HasSubstr("1 of 6 runs failed"));
    for (const json& row : series["rows"]) {
      EXPECT_TRUE(row["twist_error"].is_number() ||
                  (row["status"] == "failed" && row.contains("twist_error_reason")))
          << row;
    }
    bool missing = false;
    for (const json& mesh : series["meshes"]) {
      const json& at = mesh["twist_error"];
      missing |= at["noise"].is_null();
      EXPECT_TRUE(at["noise"].is_null() ? at.contains("noise_reason") : at["noise"] > 0.0) << mesh;
    }
    EXPECT_TRUE(missing);
  }
}

/// However its parent ends, no worker goes on: none is left, and none has finished.
TEST_F(ProgramStudy, WorkersEndWithTheirParent) {
#ifndef __linux__
  GTEST_SKIP() << "only Linux kills a process with its parent";
#endif
  std::ofstream(folder_ / "study.toml")
      << "scene = \"" << SLIPSTICK_SCENES << "/paper.toml\"\ncells = [256, 288]\n"
      << "set = { \"solver.operator\" = \"direct\" }\n";  // minutes each
  for (const int signal : {SIGKILL, SIGHUP, SIGTERM, SIGINT}) {
    const pid_t study = start("parent", "2");
    ASSERT_TRUE(slipstick::comes_true([&] { return processes().size() == 3; })) << text("parent.log");
    kill(study, signal);
    exit_code(study);
    EXPECT_TRUE(slipstick::comes_true([&] { return processes().empty(); })) << "signal " << signal;
    EXPECT_TRUE(finished().empty()) << "signal " << signal;
    for (const pid_t left : processes()) kill(left, SIGKILL);
    fs::remove_all(folder_ / "points");
  }
}

/// nohup: what is ignored when the study starts stays so.
TEST_F(ProgramStudy, AnIgnoredHangUpStaysIgnored) {
  const auto before = std::signal(SIGHUP, SIG_IGN);
  const pid_t study = start("nohup");
  std::signal(SIGHUP, before);
  while (finished().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  kill(-study, SIGHUP);
  EXPECT_EQ(exit_code(study), 0) << text("nohup.log");
}

TEST_F(ProgramStudy, BadInputIsExitCode2) {
  std::ofstream(folder_ / "study.toml")
      << "scene = \"" << SLIPSTICK_SCENES << "/paper.toml\"\ncells = [16, \"32\"]\n";
  EXPECT_EQ(exit_code(start("bad")), 2);
  EXPECT_THAT(text("bad.log"), HasSubstr("study.toml:2: cells[1]"));
  std::ofstream(folder_ / "study.toml") << "scene = \"nowhere.toml\"\ncells = [16, 32]\n";
  EXPECT_EQ(exit_code(start("missing")), 2);
  EXPECT_THAT(text("missing.log"), HasSubstr("nowhere.toml"));
}

}  // namespace
