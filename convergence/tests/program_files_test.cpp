// What commands do to files: none that is read is overwritten, a scene does not choose where is written, and
// any name will do.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "convergence/programs/run_program.hpp"
#include "convergence/programs/temporary_folder.hpp"
#include "convergence/runs/result_cache.hpp"
#include "convergence/runs/run_spec.hpp"
#include "solver/tests/scene_file.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

/// Works in a folder of its own, so that names are as short, and as odd, as users have them.
class ProgramFiles : public testing::Test {
 protected:
  ProgramFiles() : before_(fs::current_path()) { fs::current_path(folder_ / ""); }
  ~ProgramFiles() override { fs::current_path(before_); }

  static void write(const fs::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
  }
  static std::string read(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  static ProgramEnd run(std::vector<std::string> words) {
    words.insert(words.begin(), SLIPSTICK_PROGRAM);
    return run_program(words, {.captured = Captured::everything});
  }
  /// Commands that would write to what they read, as `option` says: each leaves it as it is.
  static void expect_kept(const std::string& input, const std::string& option,
                          const std::vector<std::string>& words) {
    const std::string content = read(input);
    ASSERT_FALSE(content.empty()) << input;
    const ProgramEnd end = run(words);
    EXPECT_EQ(end.code, 2) << words.front() << ' ' << option;
    EXPECT_THAT(end.output,
                AllOf(HasSubstr(option), HasSubstr("would overwrite"), HasSubstr("allowed: another file")));
    EXPECT_EQ(read(input), content) << words.front() << ' ' << option;
  }

  TemporaryFolder folder_;
  fs::path before_;
};

TEST_F(ProgramFiles, ResultsNeverOverwriteAFileOfTheCommandLine) {
  write("scene.toml", solver::kShortScene);
  write("study.toml", "scene = \"scene.toml\"\ncells = [8, 12]\n");
  write("cases.toml", "[[family]]\nname = \"f\"\nwhy = \"w\"\nscene = \"scene.toml\"\n");
  write("gates.toml",
        "[[gate]]\nid = \"a\"\nresult = \"result.json\"\nquantity = \"twist\"\nbelow = 1.0\nbasis = \"b\"\n");
  write("result.json", "{\"twist\": 0.5}");
  write("field.csv", "x1,x2,pressure,q1,q2\n0,0,1,0,1\n");
  write("profile.csv", "0,1\n1,0\n");
  expect_kept("scene.toml", "--json scene.toml", {"solve", "scene.toml", "--json", "scene.toml"});
  expect_kept("field.csv", "--json field.csv", {"check", "scene.toml", "field.csv", "--json", "field.csv"});
  expect_kept("study.toml", "--json study.toml", {"study", "study.toml", "--json", "study.toml"});
  expect_kept("cases.toml", "--json cases.toml", {"hard", "cases.toml", "--json", "cases.toml"});
  expect_kept("gates.toml", "--junit gates.toml", {"gate", "gates.toml", "--junit", "gates.toml"});
  expect_kept("gates.toml", "--summary gates.toml", {"gate", "gates.toml", "--summary", "gates.toml"});
  expect_kept("result.json", "--json result.json",
              {"compare", "result.json", "result.json", "--json", "result.json"});
  expect_kept("scene.toml", "--json scene.toml", {"report", "scene.toml", "--json", "scene.toml"});
  expect_kept("profile.csv", "--json profile.csv",
              {"exact", "--profile", "file:profile.csv", "--moment-ratio", "0.5", "--json", "profile.csv"});
}

TEST_F(ProgramFiles, ResultsNeverOverwriteAFileThatAnotherNames) {
  write("pressure.csv", "x1,x2,pressure\n0,0,1e9\n");
  write("scene.toml", std::string(solver::kShortScene) + "extent = [1e-3, 1e-3]\n");
  const std::vector<std::string> words{"solve",   "scene.toml",
                                       "--set",   "contact.pressure=file",
                                       "--set",   "contact.pressure_file=pressure.csv",
                                       "--fields"};
  const auto with = [](std::vector<std::string> some, const std::string& last) {
    some.push_back(last);
    return some;
  };
  expect_kept("pressure.csv", "--fields pressure.csv", with(words, "pressure.csv"));
  fs::copy_file("pressure.csv", "pressure-1.csv");
  std::vector<std::string> by_step = words;
  by_step[5] = "contact.pressure_file=pressure-1.csv";
  expect_kept("pressure-1.csv", "--fields pressure-1.csv", with(by_step, "pressure-{step}.csv"));
  write("study.toml", "scene = \"scene.toml\"\ncells = [8, 12]\n");
  expect_kept("scene.toml", "--json scene.toml", {"study", "study.toml", "--json", "scene.toml"});
  write("gates.toml",
        "[[gate]]\nid = \"a\"\nscene = \"scene.toml\"\nquantity = \"twist\"\nbelow = 1.0\nbasis = \"b\"\n");
  expect_kept("scene.toml", "--json scene.toml", {"gate", "gates.toml", "--json", "scene.toml"});
}

TEST_F(ProgramFiles, ResultsNeverOverwriteAnInputByAnotherName) {
  write("scene.toml", solver::kShortScene);
  fs::create_directory("below");
  fs::create_symlink("scene.toml", "link.json");
  fs::create_hard_link("scene.toml", "hard.json");
  for (const std::string name : {"./scene.toml", "below/../scene.toml", "link.json", "hard.json"}) {
    expect_kept("scene.toml", "--json " + name, {"solve", "scene.toml", "--json", name});
    expect_kept("scene.toml", "--json " + name, {"solve", "link.json", "--json", name});
  }
}

TEST_F(ProgramFiles, NamesMayHoldAnything) {
  const std::string odd = "-a b\n'c\" $x `y` <z>&{} \xff";
  write(odd + ".toml", solver::kShortScene);
  ProgramEnd end = run({"solve", "--json=" + odd + ".json", "--fields=" + odd + ".csv", "--", odd + ".toml"});
  EXPECT_EQ(end.code, 0) << end.output;
  EXPECT_TRUE(nlohmann::json::accept(read(odd + ".json")));
  end = run({"check", "--", odd + ".toml", odd + ".csv"});
  EXPECT_EQ(end.code, 0) << end.output;
  // TOML is UTF-8.
  const std::string said = "-a b\n'c\" $x `y` <z>&{} \u00ff";
  const std::string in_toml = "-a b\\n'c\\\" $x `y` <z>&{} \u00ff";
  write(said + ".toml", solver::kShortScene);
  write(said + "-study.toml",
        "scene = \"" + in_toml + ".toml\"\ncells = [8, 12]\nquantities = [\"twist_error\"]\n");
  end = run({"study", "--output=" + odd, "--json=" + odd + ".json", "--", said + "-study.toml"});
  EXPECT_EQ(end.code, 0) << end.output;
  EXPECT_TRUE(nlohmann::json::accept(read(odd + ".json")));
  write(odd + "-gates.toml", "[[gate]]\nid = \"" + in_toml + "\"\nscene = \"" + in_toml +
                                 ".toml\"\nquantity = \"twist_angle\"\nbelow = 1.0\nbasis = \"b\"\n");
  end = run({"gate", "--output=" + odd, "--junit=" + odd + ".xml", "--", odd + "-gates.toml"});
  EXPECT_EQ(end.code, 0) << end.output;
  EXPECT_FALSE(read(odd + ".xml").empty());
}

// What a result is kept under holds the scene's name and whole tables, which need not be UTF-8; JSON is.
TEST_F(ProgramFiles, ResultsOfScenesWithAnyNameAreFoundAgain) {
  const std::string scene = "caf\xe9.toml";
  write(scene, solver::kShortScene);
  const PreparedRun run = prepare_run({.scene = scene});
  const ResultCache cache("runs");
  cache.keep(run.name, run.cache_key, nlohmann::ordered_json{{"name", "caf\xe9"}});
  EXPECT_TRUE(cache.find(run.name, run.cache_key).has_value());
}

}  // namespace
}  // namespace slipstick::convergence
