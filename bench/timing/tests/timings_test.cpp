// Files of Google Benchmark, old and new, whole and broken.

#include <gmock/gmock.h>

#include "bench/compare/tests/made_timings.hpp"
#include "solver/input/tests/complaint.hpp"

namespace slipstick::bench {
namespace {

using solver::InputError;
using namespace testing;

std::string file_with(const std::string& rows, const std::string& context = "") {
  return fmt::format(R"({{"context": {{"num_cpus": 4{}}}, "benchmarks": [{}]}})", context, rows);
}

Timings parse(const std::string& text) { return parse_timings(text, "file.json"); }

std::string complaint(const std::string& text) {
  return solver::complaint([&] { parse(text); });
}

std::vector<std::string> names(const Timings& timings) {
  std::vector<std::string> names;
  for (const TimedBenchmark& benchmark : timings.benchmarks) names.push_back(benchmark.name);
  return names;
}

// As version 1.7 writes it, shortened.
constexpr const char* kFile = R"({
  "context": {
    "date": "2026-11-20T21:13:05+00:00", "host_name": "vm", "executable": "./program", "num_cpus": 2,
    "mhz_per_cpu": 2100, "cpu_scaling_enabled": true,
    "caches": [ { "type": "Data", "level": 1, "size": 32768, "num_sharing": 1 },
                { "type": "Unified", "level": 2, "size": 2097152, "num_sharing": 2 } ],
    "load_avg": [0.52,0.34,1.2], "library_build_type": "debug", "build_type": "release", "session": "s1"
  },
  "benchmarks": [
    { "name": "apply/8/repeats:2", "family_index": 0, "per_family_instance_index": 0, "run_name": "apply/8/repeats:2",
      "run_type": "iteration", "repetitions": 2, "repetition_index": 0, "threads": 2, "iterations": 331,
      "real_time": 2.1e+03, "cpu_time": 2.0e+03, "time_unit": "us", "error": 1e-16, "flops": Infinity },
    { "name": "apply/8/repeats:2", "family_index": 0, "per_family_instance_index": 0, "run_name": "apply/8/repeats:2",
      "run_type": "iteration", "repetitions": 2, "repetition_index": 1, "threads": 2, "iterations": 331,
      "real_time": 2.2e+03, "cpu_time": 2.1e+03, "time_unit": "us", "error": 2e-16, "flops": -NaN,
      "label": "a label that says NaN, \"Infinity\" and C:\\" },
    { "name": "apply/8/repeats:2_mean", "family_index": 0, "per_family_instance_index": 0,
      "run_name": "apply/8/repeats:2", "run_type": "aggregate", "aggregate_name": "mean", "aggregate_unit": "time",
      "iterations": 2, "real_time": 2.15e+03, "cpu_time": 2.05e+03, "time_unit": "us" },
    { "name": "apply_BigO", "family_index": 0, "per_family_instance_index": 0, "run_name": "apply",
      "run_type": "aggregate", "aggregate_name": "BigO", "aggregate_unit": "time", "cpu_coefficient": 1.2,
      "real_coefficient": 1.2, "big_o": "NlgN", "time_unit": "ns" },
    { "name": "apply_RMS", "run_name": "apply", "run_type": "aggregate", "aggregate_name": "RMS", "rms": 0.1 }
  ]
})";

TEST(Timings, ReadsContextAndRepetitions) {
  const Timings timings = parse(kFile);
  const TimingContext& context = timings.context;
  EXPECT_EQ(context.host_name, "vm");
  EXPECT_EQ(context.cpus, 2);
  EXPECT_EQ(context.mhz, 2100.0);
  EXPECT_THAT(context.caches, HasSubstr("2097152"));
  EXPECT_EQ(context.load_average, 0.52);
  EXPECT_EQ(context.library_build_type, "debug");
  EXPECT_EQ(context.build_type, "release");
  EXPECT_EQ(context.session, "s1");
  ASSERT_THAT(names(timings), ElementsAre("apply/8/repeats:2"));  // fits are of no benchmark
  const TimedBenchmark& benchmark = timings.benchmarks[0];
  ASSERT_EQ(benchmark.timings.size(), 2U);
  EXPECT_DOUBLE_EQ(benchmark.timings[0].real, 2.1e-3);
  EXPECT_DOUBLE_EQ(benchmark.timings[1].cpu, 2.1e-3);
  EXPECT_EQ(benchmark.threads, 2);
  EXPECT_THAT(benchmark.counters, ElementsAre(Pair("error", 2e-16)));  // no infinity, no NaN
  EXPECT_EQ(benchmark.error, "");
  EXPECT_TRUE(has_times(benchmark));
}

TEST(Timings, UnitsAreSeconds) {
  for (const auto& [unit, factor] :
       {std::pair("ns", 1e-9), std::pair("us", 1e-6), std::pair("ms", 1e-3), std::pair("s", 1.0)}) {
    const Timings timings = parse(
        file_with(fmt::format(R"({{"name": "a", "real_time": 3, "cpu_time": 2, "time_unit": "{}"}})", unit)));
    EXPECT_DOUBLE_EQ(timings.benchmarks[0].timings[0].real, 3.0 * factor);
    EXPECT_DOUBLE_EQ(timings.benchmarks[0].timings[0].cpu, 2.0 * factor);
  }
  EXPECT_THAT(complaint(file_with(R"({"name": "a", "real_time": 3, "time_unit": "min"})")),
              AllOf(HasSubstr("file.json"), HasSubstr("benchmarks[0].time_unit"), HasSubstr("min"),
                    HasSubstr("ns, us, ms, s")));
}

// A file of aggregates only has its benchmarks' names and no times.
TEST(Timings, AggregatesAloneAreNoTimes) {
  const Timings timings = parse(file_with(
      R"({"name": "sort_mean", "run_name": "sort", "run_type": "aggregate", "aggregate_name": "mean", "real_time": 10})"));
  ASSERT_THAT(names(timings), ElementsAre("sort"));
  EXPECT_FALSE(has_times(timings.benchmarks[0]));
}

TEST(Timings, TwoBenchmarksOfOneNameStayTwo) {
  const auto row = [](int family) {
    return fmt::format(
        R"({{"name": "a", "run_name": "a", "run_type": "iteration", "family_index": {}, "real_time": 1, "cpu_time": 1}})",
        family);
  };
  const Timings timings = parse(file_with(row(0) + "," + row(0) + "," + row(1)));
  ASSERT_THAT(names(timings), ElementsAre("a", "a #2"));
  EXPECT_EQ(timings.benchmarks[0].timings.size(), 2U);
  EXPECT_EQ(find(timings, "a #2"), &timings.benchmarks[1]);
  EXPECT_EQ(find(timings, "b"), nullptr);
}

TEST(Timings, FailuresAndSkipsSayWhy) {
  const Timings timings = parse(file_with(
      R"({"name": "a", "run_name": "a", "run_type": "iteration", "error_occurred": true,
          "error_message": "disagrees with its reference", "real_time": 0.0, "time_unit": "ns"},
         {"name": "b", "run_name": "b", "run_type": "iteration", "skipped": true, "skip_message": "no GPU"})"));
  EXPECT_EQ(timings.benchmarks[0].error, "disagrees with its reference");
  EXPECT_EQ(timings.benchmarks[1].error, "");
  EXPECT_EQ(timings.benchmarks[1].skipped, "no GPU");
  EXPECT_FALSE(has_times(timings.benchmarks[0]));
  EXPECT_FALSE(has_times(timings.benchmarks[1]));
}

TEST(Timings, TimesThatAreNoneAreFailures) {
  for (const char* time : {"NaN", "-NaN", "Infinity", "null", "0.0", "-1.5"}) {
    const Timings timings = parse(file_with(fmt::format(
        R"({{"name": "a", "real_time": 1, "cpu_time": 1}}, {{"name": "a", "real_time": {}, "cpu_time": 1}})",
        time)));
    EXPECT_THAT(timings.benchmarks[0].error, HasSubstr("repetition 2")) << time;
    EXPECT_FALSE(has_times(timings.benchmarks[0])) << time;
  }
}

TEST(Timings, NamesMayHoldWhatLooksLikeNoNumber) {
  const Timings timings =
      parse(file_with(R"({"name": "a \"NaN, -inf\\", "real_time": 1, "cpu_time": 1, "flops": NaN})"));
  EXPECT_THAT(names(timings), ElementsAre("a \"NaN, -inf\\"));
}

TEST(Timings, OtherFilesAreRefusedByNameAndPlace) {
  const std::string whole = kFile;
  const std::string row = R"({"name": "a", "real_time": 1})";
  for (const auto& [text, says] : std::vector<std::pair<std::string, const char*>>{
           {"hello", "Google Benchmark"},
           {whole.substr(0, whole.size() / 2), "is not JSON"},
           {"", "is not JSON"},
           {"3", "no context and benchmarks"},
           {R"({"benchmarks": []})", "no context and benchmarks"},
           {R"({"context": [], "benchmarks": []})", "no context and benchmarks"},
           {R"({"context": {}, "benchmarks": {}})", "no context and benchmarks"},
           {file_with(""), "holds no benchmark"},
           {file_with("3"), "benchmarks[0]"},
           {file_with("{}"), "benchmarks[0].name"},
           {file_with(R"({"name": "a"})"), "benchmarks[0].real_time"},
           {file_with(R"({"name": "a", "real_time": "1 ns"})"), "a number"},
           {file_with(R"({"name": "a", "real_time": 1e400})"), "1e400"},
           {file_with(row, R"(, "load_avg": 3)"), "context.load_avg"}})
    EXPECT_THAT(complaint(text), AllOf(HasSubstr("file.json"), HasSubstr(says))) << text;
  EXPECT_THROW(read_timings("/no/such/file.json"), InputError);
  EXPECT_THROW(read_timings("/"), InputError);
}

}  // namespace
}  // namespace slipstick::bench
