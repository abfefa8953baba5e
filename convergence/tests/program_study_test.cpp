// `slipstick study` as users run it: interrupted, continued, and with bad input.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

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

  /// Starts the study with its result and its messages in files of a name.
  pid_t start(const std::string& name) const {
    const pid_t child = fork();
    if (child > 0) return child;
    setpgid(0, 0);  // so that an interrupt reaches its processes, as from a terminal, and not this one
    std::freopen((folder_ / (name + ".log")).c_str(), "w", stderr);
    std::freopen((folder_ / (name + ".txt")).c_str(), "w", stdout);
    const std::string study = folder_ / "study.toml";
    const std::string points = folder_ / "points";
    const std::string result = folder_ / (name + ".json");
    execl(SLIPSTICK_PROGRAM, "slipstick", "study", study.c_str(), "--output", points.c_str(), "--json",
          result.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }

  static int exit_code(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  std::string text(const std::string& file) const {
    std::ifstream stream(folder_ / file);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  std::vector<fs::path> finished() const {
    std::vector<fs::path> files;
    if (!fs::exists(folder_ / "points")) return files;
    for (const auto& entry : fs::directory_iterator(folder_ / "points")) {
      if (entry.path().extension() == ".json") files.push_back(entry.path());
    }
    return files;
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

TEST_F(ProgramStudy, AKilledPointIsNamedAndTheOthersAreJudged) {
  const pid_t study = start("killed");
  // The largest mesh comes first; its process is the program's first child.
  const std::string children =
      "/proc/" + std::to_string(study) + "/task/" + std::to_string(study) + "/children";
  if (!std::ifstream(children)) GTEST_SKIP() << "this kernel does not tell a process's children";
  pid_t child = 0;
  while (!(std::ifstream(children) >> child)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  kill(child, SIGKILL);
  EXPECT_EQ(exit_code(study), 1) << text("killed.log");  // done, but not all of it converged
  const json result = json::parse(text("killed.json"));
  int failed = 0;
  for (const json& row : result["series"]["paper"]["rows"]) {
    if (row["status"] != "failed") continue;
    ++failed;
    EXPECT_THAT(row["message"].get<std::string>(), HasSubstr("killed by signal 9"));
    EXPECT_TRUE(row["twist_error"].is_null());
  }
  EXPECT_EQ(failed, 1);
  EXPECT_TRUE(result["series"]["paper"]["order"]["twist_error"]["value"].is_number());
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
