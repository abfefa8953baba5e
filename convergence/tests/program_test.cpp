// What `check` says and its exit codes; other commands: program_test.py.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "convergence/programs/tests/program_run.hpp"

namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

const std::string kScenes = SLIPSTICK_SCENES;

using slipstick::ProgramRun;

ProgramRun run(const std::string& arguments) { return slipstick::run_program_with(arguments); }

fs::path temporary(const std::string& name) {
  const fs::path folder =
      fs::path(testing::TempDir()) / ("slipstick-program-test-" + std::to_string(getpid()));
  fs::create_directories(folder);
  return folder / name;
}

std::string check(const std::string& field) {
  return "check " + kScenes + "/paper.toml " + SLIPSTICK_FIELDS + "/" + field;
}

TEST(Program, CheckTellsAGoodFieldFromABadOne) {
  const ProgramRun good = run(check("contact-64-0.9.csv --twist 2.361048651456917e-3"));
  EXPECT_EQ(good.exit_code, 0) << good.output;
  EXPECT_THAT(good.output, testing::StartsWith("good: "));
  const ProgramRun bad = run(check("cgcontact-64-0.9.csv --twist 2.21775472e-3"));
  EXPECT_EQ(bad.exit_code, 1) << bad.output;
  EXPECT_THAT(bad.output, AllOf(testing::StartsWith("bad: the twist is"), HasSubstr("6.1 % too low"),
                                HasSubstr("FAILS")));
}

// The exact answer, sampled, is right within its mesh; it solves no grid's own problem.
TEST(Program, CheckAsksForMoreWhereItIsTold) {
  const std::string scene = kScenes + "/paper.toml --set grid.cells=[48,48]";
  const fs::path fields = temporary("sampled.csv");
  ASSERT_EQ(run("solve " + scene + " --set solver.model=exact --fields " + fields.string()).exit_code, 0);
  const std::string sampled = "check " + scene + " " + fields.string();
  EXPECT_EQ(run(sampled).exit_code, 0);
  EXPECT_EQ(run(sampled + " --strict").exit_code, 0);
  EXPECT_EQ(run(sampled + " --discrete").exit_code, 1);
  EXPECT_EQ(run(sampled + " --tolerance 0.02").exit_code, 0);
  EXPECT_EQ(run(sampled + " --tolerance 1e-6").exit_code, 1);
  EXPECT_EQ(run(sampled + " --tolerance 0").exit_code, 2);
  EXPECT_EQ(run(check("contact-64-0.9.csv --discrete --strict")).exit_code, 0);
}

TEST(Program, CheckWritesEveryKeyOfTheContract) {
  const ProgramRun out = run(check("cgcontact-64-0.9.csv --json -"));
  ASSERT_EQ(out.exit_code, 1) << out.output;
  const json result = json::parse(out.output);
  for (const char* key : {"twist_error", "moment_error", "stick_radius_error"}) {
    EXPECT_TRUE(result[key].is_number()) << key;
  }
  for (const char* key : {"l1", "l2", "max"}) EXPECT_TRUE(result["traction_error"][key].is_number()) << key;
  for (const char* key : {"gap", "moment", "force", "friction_bound"}) {
    EXPECT_TRUE(result["certificate"][key].is_number()) << key;
  }
  for (const char* key : {"mean", "max"}) EXPECT_TRUE(result["slip_direction"][key].is_number()) << key;
  EXPECT_EQ(result["verdict"], "bad");
  EXPECT_FALSE(result["why"].get<std::string>().empty());
}

TEST(Program, CheckOfWhatCannotBeJudgedIsExitCode2) {
  const ProgramRun missing = run(check("no-such-field.csv"));
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.output, HasSubstr("no-such-field.csv"));
  const fs::path file = temporary("nan.csv");
  std::ofstream(file) << "x1,x2,pressure,q1,q2\n0,0,1,nan,0\n";
  const ProgramRun nan = run("check " + kScenes + "/paper.toml " + file.string());
  EXPECT_EQ(nan.exit_code, 2);
  EXPECT_THAT(nan.output, AllOf(HasSubstr("nan.csv: row 1"), HasSubstr("q1")));
  std::ofstream(file) << "x1,x2,p,q1,q2\n0,0,1,0,0\n";
  EXPECT_THAT(run("check " + kScenes + "/paper.toml " + file.string()).output,
              HasSubstr("no column pressure; its columns: x1, x2, p, q1, q2"));
}

}  // namespace
