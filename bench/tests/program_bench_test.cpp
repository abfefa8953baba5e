// `slipstick bench` as users run it, on made programs: exit codes, and what is written where.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "bench/compare/tests/made_program.hpp"
#include "convergence/programs/temporary_folder.hpp"
#include "convergence/programs/tests/program_run.hpp"

namespace slipstick::bench {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::made_program;

/// Two builds, of which the new one takes so many times as long.
class ProgramBench : public ::testing::Test {
 protected:
  ProgramRun ab_run(double factor, const std::string& options = "") {
    const fs::path base = made_program(folder_ / "", "base", "f/cells:8\\n", 1.0);
    const fs::path now = made_program(folder_ / "", "now", "f/cells:8\\n", factor);
    return run_program_with(fmt::format("bench --filter f --against {} --program {} --output {} {}",
                                        base.string(), now.string(), (folder_ / "out").string(), options));
  }

  convergence::TemporaryFolder folder_;
};

TEST_F(ProgramBench, IsGreenWhereNothingIsSlower) {
  const auto result = ab_run(1.01, "--rounds 10");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("repetition by repetition"));
}

TEST_F(ProgramBench, FindsWhatIsSlowerAndKeepsTheTimings) {
  const auto result = ab_run(1.15, "--rounds 10 --json " + (folder_ / "new.json").string());
  EXPECT_EQ(result.exit_code, 1) << result.output;
  EXPECT_THAT(result.output, HasSubstr("slower"));
  for (const fs::path& file : {folder_ / "new.json", folder_ / "out/base.json", folder_ / "out/new.json"}) {
    std::ifstream stream(file);
    EXPECT_EQ(nlohmann::json::parse(stream)["benchmarks"].size(), 10U) << file;
  }
}

TEST_F(ProgramBench, SaysWhenThereAreTooFewRounds) {
  const auto result = ab_run(1.5, "--rounds 3");
  EXPECT_EQ(result.exit_code, 2) << result.output;
  EXPECT_THAT(result.output, HasSubstr("too few"));
}

TEST_F(ProgramBench, ComparesTheSecondOfTwoMethodsWithTheFirst) {
  const fs::path program = made_program(folder_ / "", "both", "f\\ng\\n", 1.0);
  const auto result = run_program_with(fmt::format("bench --pair f g --program {} --output {} --rounds 2",
                                                   program.string(), (folder_ / "out").string()));
  EXPECT_THAT(result.output, AllOf(HasSubstr("g against f, "), HasSubstr("g over f")));
  EXPECT_THAT(testing::lines_of(folder_ / "log"), AllOf(Contains("both ^(f)$"), Contains("both ^(g)$")));
}

TEST_F(ProgramBench, RefusesWhatItCannotDo) {
  EXPECT_EQ(run_program_with("bench --against nothing --program nothing").exit_code, 2);
}

}  // namespace
}  // namespace slipstick::bench
