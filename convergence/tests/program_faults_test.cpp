// What the program's commands do where they cannot write: all of them in one place, since main writes for
// all.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "convergence/programs/tests/processes.hpp"

namespace slipstick {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using Words = std::vector<std::string>;

const std::string kPaper = std::string(SLIPSTICK_SCENES) + "/paper.toml";

/// What opens a file by its number, as a shell's redirection does.
void open_as(int descriptor, const fs::path& file) {
  dup2(open(file.c_str(), O_RDWR | O_CREAT | O_TRUNC, 0666), descriptor);
}

void limit_files(rlim_t bytes) {
  rlimit limit{};
  getrlimit(RLIMIT_FSIZE, &limit);
  limit.rlim_cur = bytes;
  setrlimit(RLIMIT_FSIZE, &limit);
}

class ProgramFaults : public testing::Test {
 protected:
  ProgramFaults() {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "study.toml") << "scene = \"" << kPaper << "\"\ncells = [8, 12]\n"
                                          << "quantities = [\"twist_error\"]\n";
    std::ofstream(folder_ / "gates.toml")
        << "[[gate]]\nid = \"tiny\"\nscene = \"" << kPaper
        << "\"\nset = { \"grid.cells\" = [12, 12] }\nquantity = \"status\"\n"
        << "equals = \"converged\"\nbasis = \"the solve converges\"\n";
    std::ofstream(folder_ / "hard.toml")
        << "[[family]]\nname = \"tiny\"\nwhy = \"it is small\"\nscene = \"" << kPaper
        << "\"\n[[family.vary]]\nkey = \"grid.cells\"\nvalues = [[12, 12]]\n";
  }
  ~ProgramFaults() override { fs::remove_all(folder_); }

  std::string file(const std::string& name) const { return folder_ / name; }
  std::string text(const std::string& name) const { return file_text(folder_ / name); }

  /// Commands that have a result, with little to solve and what they solve kept.
  std::vector<Words> commands() {
    const Words small{"--set", "grid.cells=[12,12]"};
    if (!fs::exists(folder_ / "fields.csv")) {
      EXPECT_EQ(run({"solve", kPaper, small[0], small[1], "--quiet", "--fields", file("fields.csv")}), 0);
    }
    return {{"exact", "--moment-ratio", "0.5"},
            {"solve", kPaper, small[0], small[1]},
            {"solve", kPaper, "--model", "exact"},
            {"check", kPaper, file("fields.csv")},
            {"study", file("study.toml"), "--output", file("points")},
            {"gate", file("gates.toml"), "--output", file("points")},
            {"hard", file("hard.toml"), "--once", "--output", file("points")}};
  }

  /// The exit code, or minus the signal that ended it. What it prints goes to the file out, and to err_ what
  /// it complains of, unless `prepare`, which is called in its process, does otherwise.
  int run(const Words& words, const std::function<void()>& prepare = {}) {
    std::array<int, 2> ends{};
    EXPECT_EQ(pipe(ends.data()), 0);
    const pid_t child = fork();
    if (child == 0) {
      open_as(STDOUT_FILENO, folder_ / "out");
      dup2(ends[1], STDERR_FILENO);
      close(ends[0]);
      close(ends[1]);
      if (prepare) prepare();
      std::vector<char*> arguments{const_cast<char*>("slipstick")};
      for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
      arguments.push_back(nullptr);
      execv(SLIPSTICK_PROGRAM, arguments.data());
      _exit(127);
    }
    close(ends[1]);
    err_.clear();
    std::array<char, 4096> buffer{};
    for (ssize_t size = 0; (size = read(ends[0], buffer.data(), buffer.size())) > 0;) {
      err_.append(buffer.data(), static_cast<std::size_t>(size));
    }
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

  static Words with(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  /// Those in the folder whose name has this in it.
  std::ptrdiff_t files_with(const std::string& part) const {
    const fs::recursive_directory_iterator entries(folder_);
    return std::count_if(begin(entries), end(entries), [&](const auto& entry) {
      return entry.path().filename().string().find(part) != std::string::npos;
    });
  }

  fs::path folder_ = fs::path(testing::TempDir()) / ("slipstick-program-faults-" + std::to_string(getpid()));
  std::string err_;
};

/// A result that went nowhere is no success. That in a file is there all the same.
TEST_F(ProgramFaults, AStandardOutputThatTakesNothingIsExitCode2) {
  const std::vector<std::function<void()>> faults{[] { open_as(STDOUT_FILENO, "/dev/full"); },
                                                  [] { close(STDOUT_FILENO); }};
  for (const Words& command : commands()) {
    for (const auto& fault : faults) {
      EXPECT_EQ(run(command, fault), 2) << command[0];
      EXPECT_THAT(err_, HasSubstr("standard output: cannot be written: "));
      EXPECT_EQ(run(with(command, {"--json", "-"}), fault), 2) << command[0];
      EXPECT_EQ(run(with(command, {"--json", file("result.json")}), fault), 2) << command[0];
      EXPECT_TRUE(nlohmann::json::parse(text("result.json"), nullptr, false).is_object()) << command[0];
      fs::remove(folder_ / "result.json");
      EXPECT_EQ(run(with(command, {"--quiet", "--json", file("result.json")}), fault), 0) << err_;
    }
  }
  EXPECT_EQ(run({"--help"}, faults[0]), 2);
}

/// Whichever streams are closed, files and pipes that get their numbers are not taken for them: HDF5 is
/// written, read in a process of its own, and studies have processes.
TEST_F(ProgramFaults, ClosedStreamsAreNoFilesOfOthers) {
  commands();
  EXPECT_EQ(run({"solve", kPaper, "--set", "grid.cells=[12,12]", "--quiet", "--fields", file("whole.h5")}),
            0);
  const Words solve{"solve", kPaper, "--set", "grid.cells=[12,12]", "--fields", file("fields.h5")};
  const Words check{"check", kPaper, file("whole.h5")};
  const Words study{"study", file("study.toml"), "--output", file("others")};
  for (int closed = 1; closed < 8; ++closed) {
    const auto close_some = [&] {
      for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if ((closed >> stream) % 2 == 1) close(stream);
      }
    };
    for (const Words& words :
         closed == 7 ? std::vector<Words>{solve, check, study} : std::vector<Words>{check}) {
      EXPECT_EQ(run(with(words, {"--quiet", "--json", file("result.json")}), close_some), 0)
          << words[0] << " " << closed << " " << err_;
      EXPECT_TRUE(nlohmann::json::parse(text("result.json"), nullptr, false).is_object());
      fs::remove(folder_ / "result.json");
    }
  }
  EXPECT_TRUE(text("fields.h5") == text("whole.h5"));
}

/// As in `slipstick study ... | head -1`: no message, nothing lost in files.
TEST_F(ProgramFaults, AReaderThatLeavesEndsItQuietly) {
  const auto nobody_reads = [] {
    std::signal(SIGPIPE, SIG_DFL);
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) _exit(126);
    close(ends[0]);
    dup2(ends[1], STDOUT_FILENO);
  };
  for (const Words& command : commands()) {
    EXPECT_EQ(run(with(command, {"--json", file("result.json")}), nobody_reads), -SIGPIPE) << command[0];
    EXPECT_THAT(err_, testing::Not(HasSubstr("slipstick:")));
    EXPECT_TRUE(nlohmann::json::parse(text("result.json"), nullptr, false).is_object()) << command[0];
    fs::remove(folder_ / "result.json");
    const auto ignored = [&] {
      nobody_reads();
      std::signal(SIGPIPE, SIG_IGN);
    };
    EXPECT_EQ(run(command, ignored), 2);
    EXPECT_THAT(err_, HasSubstr("standard output: cannot be written: Broken pipe"));
  }
}

/// Progress that nobody can read is no reason to stop.
TEST_F(ProgramFaults, AFullStandardErrorCostsNothing) {
  for (const Words& command : commands()) {
    EXPECT_EQ(run(command, [] { open_as(STDERR_FILENO, "/dev/full"); }), 0) << command[0];
    EXPECT_GT(text("out").size(), 20U);
  }
}

/// The file that an option names, on a full disk: exit code 2, and a message that names it, says why and what
/// to do. The old file stays, or none.
TEST_F(ProgramFaults, AFullDiskIsSaidAndLeavesNoPart) {
  constexpr rlim_t kSmall = 100;
  const Words solve{"solve", kPaper, "--set", "grid.cells=[12,12]"};
  std::vector<std::pair<Words, std::string>> cases;
  for (const Words& command : commands())
    cases.emplace_back(with(command, {"--json", file("x.json")}), "x.json");
  for (const char* fields : {"x.csv", "x.h5", "x.vti"}) {
    cases.emplace_back(with(solve, {"--fields", file(fields)}), fields);
  }
  cases.emplace_back(with(commands()[5], {"--junit", file("x.xml")}), "x.xml");
  cases.emplace_back(with(commands()[5], {"--summary", file("x.md")}), "x.md");
  for (const auto& [words, name] : cases) {
    run(with(words, {"--quiet"}));  // what is solved is kept
    for (const bool there : {true, false}) {
      if (there) {
        std::ofstream(folder_ / name) << "old";
      } else {
        fs::remove(folder_ / name);
      }
      const int code = run(with(words, {"--quiet"}), [] { limit_files(kSmall); });
      EXPECT_EQ(code, 2) << words[0] << " " << name;
      EXPECT_THAT(err_,
                  AllOf(HasSubstr(name + ": cannot be written: File too large"), HasSubstr("make room")));
      EXPECT_EQ(text(name), there ? "old" : "");
      EXPECT_EQ(fs::exists(folder_ / name), there);
      EXPECT_EQ(files_with(".part"), 0);
    }
  }
}

/// A study stops there, since what it solves is in vain, and goes on when there is room.
TEST_F(ProgramFaults, AStudyOnAFullDiskStopsAndGoesOn) {
  const Words study{"study", file("study.toml"), "--output", file("points"), "--json", file("result.json")};
  EXPECT_EQ(run(study, [] { limit_files(1024); }), 2);
  EXPECT_THAT(err_, AllOf(HasSubstr("cannot be written: File too large"),
                          HasSubstr("the same command goes on from there")));
  EXPECT_EQ(files_with(".json"), 0);
  EXPECT_EQ(files_with(".part"), 0);
  EXPECT_EQ(run(study), 0) << err_;
}

/// Said before anything is solved, whose text would be printed.
TEST_F(ProgramFaults, WhereNothingCanBeWrittenNothingIsSolved) {
  const Words small{"solve", kPaper, "--set", "grid.cells=[12,12]"};
  const std::string lost = file("no/such/folder/x");
  std::ofstream(folder_ / "plain") << "a file";
  fs::create_directories(folder_ / "d.csv");
  const std::vector<std::pair<Words, std::string>> cases{
      {with(small, {"--json", lost}), "--json " + lost},
      {with(small, {"--json", folder_}), "--json " + folder_.string()},
      {with(small, {"--fields", lost + ".h5"}), "--fields " + lost + ".h5"},
      {with(small, {"--fields", file("d.csv")}), "--fields " + file("d.csv")},
      {with(small, {"--figure", lost + ".svg"}), lost + ".svg"},
      {{"study", file("study.toml"), "--output", file("plain")}, file("plain")},
      {{"report", "--quick", "--output", file("plain/report")}, file("plain/report")},
      {{"gate", file("gates.toml"), "--junit", lost}, "--junit " + lost}};
  for (const auto& [words, name] : cases) {
    EXPECT_EQ(run(words), 2) << name;
    EXPECT_THAT(err_, AllOf(StartsWith("slipstick: " + name), HasSubstr("cannot be written: ")));
    EXPECT_EQ(text("out"), "");
  }
}

}  // namespace
}  // namespace slipstick
