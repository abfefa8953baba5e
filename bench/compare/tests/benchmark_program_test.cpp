#include "bench/compare/benchmark_program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/compare/tests/made_program.hpp"
#include "convergence/programs/temporary_folder.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::bench {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using testing::lines_of;
using testing::made_program;

TEST(BenchmarkFilter, NamesStandForThemselves) {
  EXPECT_EQ(benchmark_filter({"a|b/(1)/x.y", "c"}), R"(^(a\|b/\(1\)/x\.y|c)$)");
}

TEST(BenchmarkProgram, FindsANameThatIsARegularExpressionToo) {
  const convergence::TemporaryFolder folder;
  const fs::path a = made_program(folder / "", "a", "f\\n");
  run_benchmark(a, "f<2.5>(x)/cells:8", {});
  EXPECT_THAT(lines_of(folder / "log"), ElementsAre("a ^(f<2\\.5>\\(x\\)/cells:8)$"));
}

TEST(BenchmarkProgram, ListsWhatItHas) {
  const convergence::TemporaryFolder folder;
  EXPECT_THAT(list_benchmarks(made_program(folder / "", "a", "f/8\\ng\\n"), ""), ElementsAre("f/8", "g"));
  EXPECT_THROW(list_benchmarks(made_program(folder / "", "b", ""), "f"), solver::InputError);
  EXPECT_THROW(list_benchmarks(folder / "nothing", ""), solver::InputError);
}

TEST(BenchmarkProgram, SaysWhichBenchmarkFailed) {
  const convergence::TemporaryFolder folder;
  const fs::path a = made_program(folder / "", "a", "f\\n", 1.0, 3);
  try {
    run_benchmark(a, "some/name", {});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("some/name ended with code 3"));
  }
}

}  // namespace
}  // namespace slipstick::bench
