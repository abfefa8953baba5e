// Comparison of two runs: slower benchmarks, and benchmarks that cannot be judged.

#include <gmock/gmock.h>

#include <functional>
#include <stdexcept>

#include "bench/compare/tests/made_timings.hpp"

namespace slipstick::bench {
namespace {

using namespace testing;

constexpr std::size_t kRepetitions = 10;

/// Both files have `others` steady benchmarks in addition to the given ones.
TwoTimings run_of(const std::vector<TimedBenchmark>& base, const std::vector<TimedBenchmark>& now,
                  int others = 3) {
  TwoTimings run{file_of("base.json", base), file_of("new.json", now)};
  for (int i = 0; i < others; ++i) {
    const std::string name = "steady/" + std::to_string(i);
    run.base.benchmarks.push_back(steady(name, 1e-3, kRepetitions, 100 + i));
    run.now.benchmarks.push_back(steady(name, 1e-3, kRepetitions, 200 + i));
  }
  return run;
}

TwoTimings steady_run() { return run_of({}, {}); }

/// One benchmark, in the new file `factor` times as long.
TwoTimings changed(double factor, std::size_t repetitions = kRepetitions) {
  return run_of({steady("it", 1e-3, repetitions, 1)}, {steady("it", factor * 1e-3, repetitions, 2)});
}

ComparedBenchmark found(const Comparison& comparison, const std::string& name = "it") {
  for (const ComparedBenchmark& benchmark : comparison.benchmarks) {
    if (benchmark.name == name) return benchmark;
  }
  ADD_FAILURE() << "no " << name;
  return {};
}

void expect_found(const TwoTimings& run, Finding finding, int code, const std::string& remark = "",
                  const ComparisonRules& rules = {}) {
  const Comparison comparison = compare(run, rules);
  EXPECT_EQ(found(comparison).finding, finding);
  EXPECT_EQ(exit_code(comparison), code);
  EXPECT_THAT(found(comparison).remark, HasSubstr(remark));
}

TEST(Comparison, RatioIsWithinTheSpreadOfTheTimes) {
  const ComparedBenchmark it = found(compare(changed(1.3)));
  EXPECT_NEAR(it.ratio, 1.3, 0.01);
  EXPECT_LT(it.low, it.ratio);
  EXPECT_GT(it.high, it.ratio);
  EXPECT_NEAR(it.base_seconds, 1e-3, 5e-6);
  EXPECT_NEAR(it.new_seconds, 1.3e-3, 7e-6);
  // Separated samples of 10 and 10, one of four.
  EXPECT_NEAR(it.p_value, 4.0 / 184756.0, 1e-12);
  EXPECT_EQ(it.base_repetitions, kRepetitions);
}

TEST(Comparison, OnlyAChangeThatCountsIsSlower) {
  expect_found(changed(1.15), Finding::slower, 1);
  expect_found(changed(1.08), Finding::same, 0);  // significant, but too small to count
  EXPECT_LT(found(compare(changed(1.08))).p_value, 0.01);
  expect_found(changed(1.0), Finding::same, 0);
  expect_found(changed(1.0 / 1.08), Finding::same, 0);
  expect_found(changed(1.0 / 1.15), Finding::quicker, 0);
  expect_found(changed(1.08), Finding::slower, 1, "", {.effect = 0.05});
  expect_found(changed(1.15), Finding::same, 0, "", {.effect = 0.2});
}

TEST(Comparison, SaysWhereAnIntervalLeavesMoreOpenThanAPass) {
  expect_found(changed(1.06), Finding::same, 0, "slower, below what counts");
  std::vector<double> scattered;
  for (int i = 0; i < 10; ++i) scattered.push_back(1e-3 * (1.0 + 0.05 * i));
  const std::vector<double> reversed(scattered.rbegin(), scattered.rend());
  expect_found(run_of({timed("it", scattered)}, {timed("it", reversed)}), Finding::same, 0,
               "scatters too much to rule 10 % out");
}

// 56 of the hundred differences are positive, most by a third: the median is, and the ranks prove nothing.
TEST(Comparison, SlowerByChanceIsUndecided) {
  std::vector<double> base;
  std::vector<double> now;
  for (int i = 0; i < 10; ++i) {
    const double close = 1.0 + 0.001 * i;
    base.push_back(close * (i < 3 ? 1.6 : 1.0));
    now.push_back(close * (i < 8 ? 1.3 : 0.9));
  }
  const TwoTimings run = run_of({timed("it", base)}, {timed("it", now)});
  expect_found(run, Finding::undecided, 2);
  EXPECT_GE(found(compare(run)).ratio, 1.1);
  EXPECT_GT(found(compare(run)).p_value, 0.01);
}

// Holm (1979): the least chance of m benchmarks counts m times. Here all but one of 36 pairs of 6 and 6
// repetitions stand one way, with the chance 2 / C(12, 6) = 2/924: 4 times that is below the level of 0.01, 5
// times is above.
TEST(Comparison, CountsTheLeastChanceAsOftenAsThereAreBenchmarks) {
  for (const double factor : {0.8, 1.25}) {
    std::vector<double> base;
    std::vector<double> now;
    for (int i = 0; i < 6; ++i) {
      base.push_back(1.0 + 0.001 * i);
      now.push_back(factor * (1.0 + 0.001 * i));
    }
    (factor < 1.0 ? now.back() : now.front()) = factor < 1.0 ? 1.0005 : 1.0045;
    const auto among = [&](int others) {
      return found(compare(run_of({timed("it", base)}, {timed("it", now)}, others)));
    };
    EXPECT_NEAR(among(3).p_value, 8.0 / 924.0, 1e-12);
    EXPECT_EQ(among(3).finding, factor < 1.0 ? Finding::quicker : Finding::slower);
    EXPECT_NEAR(among(4).p_value, 10.0 / 924.0, 1e-12);
    EXPECT_EQ(among(4).finding, factor < 1.0 ? Finding::same : Finding::undecided);
  }
}

// Four benchmarks: 4 / C(2 n, n) <= 0.01 from n = 6 on (924; 252 for n = 5).
TEST(Comparison, TooFewRepetitionsAreNoPass) {
  expect_found(changed(2.0, 3), Finding::too_few, 2, "6 repetitions");
  expect_found(changed(1.0, 1), Finding::too_few, 2);
  expect_found(changed(2.0, 6), Finding::slower, 1);
}

TEST(Comparison, PairsNeedMoreRepetitions) {
  std::mt19937_64 generator(3);
  const Noise quiet{.scatter = 0.001, .outliers = 0.0};
  // 30 / 2^n <= 0.01 from n = 12 on.
  const Comparison few = compare(draw(generator, 30, 11, true, quiet, 1, 2.0));
  EXPECT_TRUE(few.paired);
  EXPECT_EQ(few.benchmarks[0].finding, Finding::too_few);
  EXPECT_THAT(few.benchmarks[0].remark, HasSubstr("12 repetitions"));
  EXPECT_EQ(exit_code(few), 2);
  EXPECT_EQ(exit_code(compare(draw(generator, 30, 12, true, quiet, 1, 2.0))), 1);
  EXPECT_FALSE(compare(draw(generator, 30, 11, false, quiet)).paired);
}

TEST(Comparison, BenchmarksInOneFileAreReported) {
  const auto it = [](const std::string& name) { return steady(name, 1e-3, kRepetitions, 5); };
  expect_found(run_of({it("it")}, {}), Finding::only_in_base, 2);
  expect_found(run_of({}, {it("it")}), Finding::only_in_new, 2);
  EXPECT_EQ(exit_code(compare(run_of({it("a")}, {it("b")}, 0))), 2);
  const Comparison ordered = compare(run_of({it("b"), it("a")}, {it("new"), it("a"), it("b")}, 0));
  std::vector<std::string> names;
  for (const ComparedBenchmark& benchmark : ordered.benchmarks) names.push_back(benchmark.name);
  EXPECT_THAT(names, ElementsAre("b", "a", "new"));  // the base's order
}

TEST(Comparison, FailuresCountWhereTheyAreNew) {
  TimedBenchmark failed = timed("it", {});
  failed.error = "disagrees with its reference";
  TimedBenchmark skipped = timed("it", {});
  skipped.skipped = "no GPU";
  const TimedBenchmark good = steady("it", 1e-3, kRepetitions, 1);
  expect_found(run_of({good}, {failed}), Finding::failed, 1, "disagrees with its reference");
  expect_found(run_of({failed}, {good}), Finding::not_timed, 2, "in the base");
  expect_found(run_of({failed}, {failed}), Finding::not_timed, 2, "in the base");
  expect_found(run_of({good}, {skipped}), Finding::not_timed, 2, "skipped: no GPU");
  expect_found(run_of({good}, {timed("it", {})}), Finding::not_timed, 2, "aggregates only");
  for (const double time : {std::nan(""), HUGE_VAL, 0.0, -1.0}) {
    TimedBenchmark bad = good;
    bad.timings[4].real = time;
    expect_found(run_of({good}, {bad}), Finding::failed, 1);
    expect_found(run_of({bad}, {good}), Finding::not_timed, 2);
  }
}

TEST(Comparison, NothingComparedIsNoPass) { EXPECT_EQ(exit_code(Comparison{}), 2); }

TEST(Comparison, RulesThatMeanNothingAreRefused) {
  for (const double effect : {0.0, -0.1, std::nan("")})
    EXPECT_THROW(compare(steady_run(), {.effect = effect}), std::invalid_argument);
  for (const double level : {0.0, 1.0, std::nan("")})
    EXPECT_THROW(compare(steady_run(), {.level = level}), std::invalid_argument);
}

using Change = std::function<void(TwoTimings&)>;

/// The obstacle after a change to the files, one of which is slower by half; empty: none.
std::string obstacle(const Change& change, const ComparisonRules& rules = {}) {
  TwoTimings run = changed(1.5);
  change(run);
  const Comparison comparison = compare(run, rules);
  if (comparison.obstacles.empty()) {
    EXPECT_EQ(exit_code(comparison), 1);
    return "";
  }
  EXPECT_EQ(exit_code(comparison), 2);
  EXPECT_EQ(found(comparison).finding, Finding::not_judged);
  EXPECT_NEAR(found(comparison).ratio, 1.5, 0.02);  // the numbers stay
  return comparison.obstacles.front();
}

TEST(Obstacles, DifferentMachines) {
  EXPECT_EQ(obstacle([](TwoTimings&) {}), "");
  const std::vector<std::pair<std::string, Change>> changes{
      {"num_cpus", [](TwoTimings& run) { run.now.context.cpus = 4; }},
      {"host_name", [](TwoTimings& run) { run.now.context.host_name = "elsewhere"; }},
      {"mhz_per_cpu", [](TwoTimings& run) { run.now.context.mhz *= 1.06; }},
      {"mhz_per_cpu", [](TwoTimings& run) { run.now.context.mhz = std::nan(""); }},
      {"caches", [](TwoTimings& run) { run.now.context.caches = R"([{"level":2}])"; }}};
  for (const auto& [what, change] : changes) {
    EXPECT_THAT(obstacle(change), AllOf(HasSubstr("machines differ"), HasSubstr(what)));
    EXPECT_EQ(obstacle(change, {.same_machine = true}), "") << what;
  }
  EXPECT_EQ(obstacle([](TwoTimings& run) { run.now.context.mhz *= 1.04; }), "");
  EXPECT_EQ(obstacle([](TwoTimings& run) {  // one session is of one machine, whose clock may change
              run.base.context.session = run.now.context.session = "one";
              run.now.context.mhz *= 2.0;
            }),
            "");
}

TEST(Obstacles, DebugBuilds) {
  const auto library = [](TwoTimings& run) { run.base.context.library_build_type = "debug"; };
  EXPECT_THAT(obstacle(library), AllOf(HasSubstr("base.json"), HasSubstr("--debug-library")));
  EXPECT_EQ(obstacle(library, {.debug_library = true}), "");
  EXPECT_EQ(obstacle([](TwoTimings& run) {
              run.now.context.library_build_type = "debug";
              run.now.context.build_type = "release";
            }),
            "");
  EXPECT_THAT(
      obstacle([](TwoTimings& run) { run.now.context.build_type = "Debug"; }, {.debug_library = true}),
      AllOf(HasSubstr("new.json"), HasSubstr("debug build")));
}

TEST(Obstacles, LoadThatTheRunDoesNotExplain) {
  for (const bool in_base : {true, false}) {
    const auto load = [&](double average, int threads) {
      return [=](TwoTimings& run) {
        Timings& timings = in_base ? run.base : run.now;
        timings.context.load_average = average;
        timings.benchmarks.back().threads = threads;
      };
    };
    EXPECT_THAT(obstacle(load(5.1, 1)),
                AllOf(HasSubstr(in_base ? "base.json" : "new.json"), HasSubstr("loaded")));
    EXPECT_EQ(obstacle(load(4.9, 1)), "");
    EXPECT_EQ(obstacle(load(5.1, 2)), "");
  }
}

/// The first benchmarks of a file take longer by the clock than by the processor's time.
void wait(Timings& file, double factor, std::size_t count = 4) {
  for (std::size_t i = 0; i < std::min(count, file.benchmarks.size()); ++i) {
    for (Timing& timing : file.benchmarks[i].timings) timing.cpu = timing.real / factor;
  }
}

TEST(Obstacles, MostBenchmarksWait) {
  EXPECT_THAT(obstacle([](TwoTimings& run) { wait(run.now, 1.6); }),
              AllOf(HasSubstr("new.json"), HasSubstr("4 of 4")));
  EXPECT_THAT(obstacle([](TwoTimings& run) { wait(run.base, 1.6); }), HasSubstr("base.json"));
  EXPECT_EQ(obstacle([](TwoTimings& run) { wait(run.now, 1.2); }), "");
  EXPECT_EQ(obstacle([](TwoTimings& run) { wait(run.now, 20.0); }), "");    // by their nature
  EXPECT_EQ(obstacle([](TwoTimings& run) { wait(run.now, 1.6, 2); }), "");  // a sleep in two of four
  EXPECT_EQ(obstacle([](TwoTimings& run) {                                  // both sides of a pair wait alike
              wait(run.now, 1.6);
              run.base.context.session = run.now.context.session = "one";
            }),
            "");
  EXPECT_EQ(obstacle([](TwoTimings& run) {  // three programs bring their own clock
              wait(run.now, 1.6);
              for (Timings* const timings : {&run.base, &run.now})
                for (std::size_t i = 1; i < 4; ++i) timings->benchmarks[i].name += "/manual_time";
            }),
            "");
}

TEST(Obstacles, OneRunAgainstItself) {
  TwoTimings run = steady_run();
  run.now.benchmarks = run.base.benchmarks;
  EXPECT_THAT(compare(run).obstacles, ElementsAre(HasSubstr("compared with itself")));
  EXPECT_EQ(exit_code(compare(run)), 2);
}

Comparison of_finding(Finding finding) {
  Comparison comparison;
  ComparedBenchmark& benchmark = comparison.benchmarks.emplace_back();
  benchmark.name = "it";
  benchmark.finding = finding;
  return comparison;
}

TEST(SecondRun, OnlyWhatItConfirmsCounts) {
  using enum Finding;
  struct Case {
    Finding first;
    std::vector<Finding> second;
    int code;
  };
  for (const auto& [first, seconds, code] :
       {Case{slower, {slower}, 1}, Case{failed, {failed}, 1},
        Case{undecided, {slower}, 1},  // the second run is a test of its own
        Case{failed, {slower}, 2}, Case{slower, {failed}, 2}, Case{slower, {same, quicker}, 0},
        Case{failed, {same, quicker}, 0}, Case{undecided, {same, quicker}, 0},
        Case{slower, {undecided, not_judged, only_in_base, too_few, not_timed}, 2},
        Case{failed, {undecided, not_judged, only_in_base, too_few, not_timed}, 2},
        Case{undecided, {undecided, not_judged, only_in_base, too_few, not_timed}, 2}}) {
    for (const Finding second : seconds)
      EXPECT_EQ(exit_code(confirm(of_finding(first), of_finding(second))), code)
          << to_string(first) << ", " << to_string(second);
  }
  EXPECT_EQ(exit_code(confirm(of_finding(slower), {})), 2);
  EXPECT_EQ(exit_code(confirm(of_finding(same), {})), 0);
  Comparison on_another_machine;
  on_another_machine.obstacles = {"the machines differ"};
  EXPECT_EQ(exit_code(confirm(of_finding(same), on_another_machine)), 2);
  const Comparison cleared = confirm(of_finding(slower), of_finding(same));
  EXPECT_THAT(cleared.benchmarks[0].remark, AllOf(HasSubstr("first run: slower"), HasSubstr("second: same")));
  Comparison first = of_finding(slower);
  Comparison second = first;
  first.benchmarks[0].p_value = 0.04;
  second.benchmarks[0].p_value = 0.002;
  EXPECT_EQ(confirm(first, second).benchmarks[0].p_value, 0.002);  // of the test that decided
  EXPECT_EQ(confirm(first, {}).benchmarks[0].p_value, 0.04);
}

}  // namespace
}  // namespace slipstick::bench
