#include "bench/compare/rounds.hpp"

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

TEST(Rounds, TurnTheOrderRoundEveryTime) {
  const convergence::TemporaryFolder folder;
  const fs::path a = made_program(folder / "", "a", "f\\n");
  const fs::path b = made_program(folder / "", "b", "f\\n");
  std::vector<std::string> done;
  run_in_turn({{{a, "f", "f"}, {b, "f", "f"}}, {{a, "g", "g"}, {b, "", "g"}}}, 2, {},
              [&](const Heat& heat) { done.push_back(heat.front().name); });
  EXPECT_THAT(lines_of(folder / "log"),
              ElementsAre("a ^(f)$", "b ^(f)$", "a ^(g)$", "b ^(f)$", "a ^(f)$", "a ^(g)$"));
  EXPECT_THAT(done, ElementsAre("f", "g", "f", "g"));
}

TEST(Rounds, MakeOneFileAPlaceWithARepetitionARound) {
  const convergence::TemporaryFolder folder;
  const fs::path a = made_program(folder / "", "a", "f\\n");
  const auto files = run_in_turn({{{a, "f", "common"}, {a, "g", "common"}}}, 3, {}, {}).files;
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[0]["context"]["sitting"], files[1]["context"]["sitting"]);
  for (const auto& file : files) {
    ASSERT_EQ(file["benchmarks"].size(), 3U);  // no aggregates
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(file["benchmarks"][i]["run_name"], "common");
      EXPECT_EQ(file["benchmarks"][i]["repetition_index"], i);
    }
  }
}

TEST(Rounds, OfTwoSittingsAreToldApart) {
  const convergence::TemporaryFolder folder;
  const fs::path a = made_program(folder / "", "a", "f\\n");
  const auto sitting = [&] {
    return run_in_turn({{{a, "f", "f"}}}, 1, {}, {}).files[0]["context"]["sitting"];
  };
  EXPECT_NE(sitting(), sitting());
}

TEST(Rounds, RunAHeatAgainAfterWhichTheMachineWasSlow) {
  const convergence::TemporaryFolder folder;
  const fs::path a = made_program(folder / "", "a", "f\\n");
  const std::vector<bool> full{true, false, false, true,
                               true, true,  true};  // before, after; pause, before, after; ...
  std::size_t asked = 0;
  const Sitting sitting = run_in_turn({{{a, "f", "f"}}}, 2, {}, {}, [&] { return full.at(asked++); });
  EXPECT_EQ(lines_of(folder / "log").size(), 3U);
  EXPECT_EQ(asked, full.size());
  EXPECT_EQ(sitting.heats, 2U);
  EXPECT_EQ(sitting.unsteady, 0U);
  EXPECT_EQ(sitting.files[0]["benchmarks"].size(), 2U);
}

TEST(Rounds, FindANameThatIsARegularExpressionToo) {
  const convergence::TemporaryFolder folder;
  const fs::path a = made_program(folder / "", "a", "f\\n");
  run_benchmark(a, "f<2.5>(x)/cells:8", {});
  EXPECT_THAT(lines_of(folder / "log"), ElementsAre("a ^(f<2\\.5>\\(x\\)/cells:8)$"));
}

TEST(Rounds, ListWhatAProgramHas) {
  const convergence::TemporaryFolder folder;
  EXPECT_THAT(list_benchmarks(made_program(folder / "", "a", "f/8\\ng\\n"), ""), ElementsAre("f/8", "g"));
  EXPECT_THROW(list_benchmarks(made_program(folder / "", "b", ""), "f"), solver::InputError);
  EXPECT_THROW(list_benchmarks(folder / "nothing", ""), solver::InputError);
}

TEST(Rounds, SayWhichBenchmarkFailed) {
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
