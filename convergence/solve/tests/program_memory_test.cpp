// What a solve will take is known before it is taken: --plan, --memory-limit and the process itself agree.

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "convergence/programs/temporary_folder.hpp"
#include "convergence/programs/tests/program_run.hpp"
#include "convergence/runs/process_pool.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // which takes memory of its own
#else
constexpr bool kSanitized = false;
#endif

const std::string kPaperScene = std::string(SLIPSTICK_SCENES) + "/paper.toml";

std::string solve_of(const std::string& scene, const std::string& arguments) {
  return fmt::format("solve {}/{}.toml {}", SLIPSTICK_SCENES, scene, arguments);
}

TEST(Memory, PredictedIsAnUpperBoundOfWhatIsTakenAndNotMuchMore) {
  if (kSanitized) GTEST_SKIP() << "sanitizers take memory of their own";
  const std::string loose = " --set solver.tolerance=1e-3 --json -";
  for (const std::string& arguments :
       {solve_of("paper", "--set grid.cells=[320,320]"),
        solve_of("paper", "--set grid.cells=[256,256] --model full"),
        solve_of("paper", "--set grid.cells=[36,36] --set solver.operator=dense --model full"),
        solve_of("torsion_and_force", "--set grid.cells=[160,160]"),
        solve_of("dissimilar", "--set grid.cells=[128,128] --set contact.coupling=full")}) {
    const ProgramRun out = run_program_with(arguments + loose);
    ASSERT_EQ(out.exit_code, 0) << out.output;
    const Json result = Json::parse(out.output);
    const double predicted = result["predicted_bytes"];
    const double taken = result["peak_bytes"];
    EXPECT_GE(predicted, taken) << arguments;
    EXPECT_LE(predicted, 1.7 * taken) << arguments;
  }
}

TEST(Memory, LimitIsWhatAPlanMayNeed) {
  const std::string small = "--set grid.cells=[16,16] ";
  const ProgramRun plan = run_program_with(solve_of("paper", small + "--plan --json -"));
  const double bytes = Json::parse(plan.output)["plan"]["bytes"];
  const auto within = [&](double limit) {
    return run_program_with(solve_of("paper", small + fmt::format("--quiet --memory-limit {:.0f}", limit)));
  };
  EXPECT_EQ(within(bytes + 2.0).exit_code, 0);
  const ProgramRun refused = within(bytes - 2.0);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.output, AllOf(HasSubstr("paper.toml"), HasSubstr("grid.cells = [16, 16]"),
                                    HasSubstr("--memory-limit"), HasSubstr("fewer cells")));
  EXPECT_EQ(run_program_with(solve_of("paper", small + "--quiet --memory-limit 1GiB")).exit_code, 0);
  EXPECT_EQ(run_program_with(solve_of("paper", small + "--memory-limit some")).exit_code, 2);
}

// One field of this grid takes 7 GB. What may be taken at all is a tenth of that.
TEST(Memory, IsNotTakenByWhatIsRefused) {
  if (kSanitized) GTEST_SKIP() << "sanitizers take memory of their own";
  const ProgramRun out =
      run_command(fmt::format("ulimit -v 700000; {} {}", SLIPSTICK_PROGRAM,
                              solve_of("paper", "--set grid.cells=[30000,30000] --memory-limit 1GiB")));
  EXPECT_EQ(out.exit_code, 2);
  EXPECT_THAT(out.output, AllOf(HasSubstr("grid.cells = [30000, 30000]"), HasSubstr("1 GiB are allowed")));
}

TEST(Memory, LimitHoldsForCommandsOfManySolves) {
  const TemporaryFolder folder;
  const auto write = [&](const char* name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return (folder / name).string();
  };
  const std::string scene = fmt::format("scene = \"{}\"\n", kPaperScene);
  const std::string study = write("study.toml", scene + "cells = [8, 12]\n");
  const std::string gates =
      write("gates.toml",
            "[[gate]]\nid = \"a\"\n" + scene + "quantity = \"twist_error\"\nbelow = 1.0\nbasis = \"b\"\n");
  const std::string options = fmt::format(" --memory-limit 1MB --output {}", (folder / "runs").string());
  for (const std::string& command : {"study " + study, "gate " + gates}) {
    const ProgramRun out = run_program_with(command + options);
    EXPECT_EQ(out.exit_code, 2) << command;
    EXPECT_THAT(out.output, AllOf(HasSubstr("paper.toml"), HasSubstr("--memory-limit"))) << command;
  }
}

// With more memory the same scene has an answer.
TEST(Memory, RefusalsAreNotKept) {
  const TemporaryFolder folder;
  const RunSpec spec{.scene = kPaperScene, .overrides = {"grid.cells=[16,16]"}};
  ProcessPoolOptions options{.folder = folder / "runs", .memory_limit = 1e6, .program = SLIPSTICK_PROGRAM};
  const Json refused = ProcessPool(options).run(spec);
  EXPECT_EQ(refused["status"], "refused");
  EXPECT_THAT(refused["message"].get<std::string>(), HasSubstr("--memory-limit"));
  options.memory_limit = 1e9;
  EXPECT_EQ(ProcessPool(options).run(spec)["status"], "converged");
}

}  // namespace
}  // namespace slipstick::convergence
