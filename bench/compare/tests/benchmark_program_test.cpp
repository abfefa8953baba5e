#include "bench/compare/benchmark_program.hpp"

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <chrono>
#include <fstream>

#include "convergence/programs/temporary_folder.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::bench {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;

/// A program that behaves as Google Benchmark's do, with a list of benchmarks ("f\\ng\\n"); it notes each of
/// its runs as "label filter" in the file "log" of the folder.
fs::path made_program(const fs::path& folder, const std::string& label, const std::string& list) {
  const fs::path program = folder / label;
  std::ofstream(program) << fmt::format(R"(#!/bin/sh
for word in "$@"; do
  case "$word" in
    --benchmark_list_tests) printf '{1}'; exit 0;;
    --benchmark_filter=*) filter="${{word#*=}}";;
    --benchmark_out=*) out="${{word#*=}}";;
  esac
done
echo "{0} $filter" >> '{2}'
cat > "$out" <<END
{{"context": {{"num_cpus": 2, "build_type": "release"}}, "benchmarks": [
 {{"name": "x", "run_name": "x", "run_type": "iteration", "real_time": 1, "cpu_time": 1, "time_unit": "ms"}},
 {{"name": "x_mean", "run_name": "x", "run_type": "aggregate", "real_time": 1, "cpu_time": 1, "time_unit": "ms"}}]}}
END
)",
                                        label, list, (folder / "log").string());
  fs::permissions(program, fs::perms::owner_all);
  return program;
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::vector<std::string> lines;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(BenchmarkProgram, ListsWhatItHas) {
  const convergence::TemporaryFolder folder;
  EXPECT_THAT(list_benchmarks(made_program(folder / "", "a", "f/8\\ng\\n"), ""), ElementsAre("f/8", "g"));
  EXPECT_THROW(list_benchmarks(made_program(folder / "", "b", ""), "f"), solver::InputError);
  EXPECT_THROW(list_benchmarks(folder / "nothing", ""), solver::InputError);
}

TEST(Survey, RunsWhatIsNotOnDiskYet) {
  const convergence::TemporaryFolder folder;
  const auto program = made_program(folder / "", "a", "f\\n");
  run_survey(program, {"f/cells:8"}, {}, folder / "kept");
  const auto all = run_survey(program, {"f/cells:8", "f_cells_8"}, {}, folder / "kept");
  EXPECT_THAT(lines_of(folder / "log"), ElementsAre("a ^(f/cells:8)$", "a ^(f_cells_8)$"));
  EXPECT_EQ(all["benchmarks"].size(), 4U);  // aggregates too
}

TEST(Survey, RunsAnotherProgramAndAnotherLengthAnew) {
  const convergence::TemporaryFolder folder;
  const auto program = made_program(folder / "", "a", "f\\n");
  run_survey(program, {"f"}, {.seconds = 0.1}, folder / "kept");
  run_survey(program, {"f"}, {.seconds = 0.2}, folder / "kept");
  fs::last_write_time(program, fs::last_write_time(program) + std::chrono::seconds(1));
  run_survey(program, {"f"}, {.seconds = 0.2}, folder / "kept");
  EXPECT_EQ(lines_of(folder / "log").size(), 3U);
}

}  // namespace
}  // namespace slipstick::bench
