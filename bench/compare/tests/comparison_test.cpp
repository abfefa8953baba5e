// Two runs compared: what counts as slower, and what cannot be judged.

#include "bench/compare/comparison.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>

#include "bench/compare/tests/made_timings.hpp"

namespace slipstick::bench {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::size_t kRepetitions = 10;

/// Both files have `other` steady benchmarks beside what is asked for.
TwoFiles run_of(const std::vector<TimedBenchmark>& base, const std::vector<TimedBenchmark>& now,
                int others = 3) {
  TwoFiles run{file_of("base.json", base), file_of("new.json", now)};
  for (int i = 0; i < others; ++i) {
    const std::string name = "steady/" + std::to_string(i);
    run.base.benchmarks.push_back(steady(name, 1e-3, kRepetitions, 100 + i));
    run.now.benchmarks.push_back(steady(name, 1e-3, kRepetitions, 200 + i));
  }
  return run;
}

TwoFiles steady_run() { return run_of({}, {}); }

/// One benchmark, in the new file `factor` times as long.
TwoFiles changed(double factor, std::size_t repetitions = kRepetitions) {
  return run_of({steady("it", 1e-3, repetitions, 1)}, {steady("it", factor * 1e-3, repetitions, 2)});
}

ComparedBenchmark found(const Comparison& comparison, const std::string& name) {
  for (const ComparedBenchmark& benchmark : comparison.benchmarks) {
    if (benchmark.name == name) return benchmark;
  }
  ADD_FAILURE() << "no " << name;
  return {};
}

Finding finding(const TwoFiles& run, const std::string& name = "it") {
  return found(compare(run), name).finding;
}

TEST(Comparison, RatioIsWithinTheSpreadOfTheTimes) {
  const ComparedBenchmark it = found(compare(changed(1.3)), "it");
  EXPECT_NEAR(it.ratio, 1.3, 0.01);
  EXPECT_LT(it.low, it.ratio);
  EXPECT_GT(it.high, it.ratio);
  EXPECT_NEAR(it.base_seconds, 1e-3, 5e-6);
  EXPECT_NEAR(it.new_seconds, 1.3e-3, 7e-6);
  // Separated samples of 10 and 10, one of four.
  EXPECT_NEAR(it.p_value, 4.0 / 184756.0, 1e-12);
  EXPECT_EQ(it.base_repetitions, kRepetitions);
}

TEST(Comparison, OnlyWhatIsAsMuchSlowerAsCountsIsSlower) {
  EXPECT_EQ(finding(changed(1.15)), Finding::slower);
  EXPECT_EQ(finding(changed(1.08)), Finding::same);  // significant, but too small to count
  EXPECT_LT(found(compare(changed(1.08)), "it").p_value, 0.01);
  EXPECT_EQ(finding(changed(1.0)), Finding::same);
  EXPECT_EQ(finding(changed(1.0 / 1.08)), Finding::same);
  EXPECT_EQ(finding(changed(1.0 / 1.15)), Finding::quicker);
  EXPECT_EQ(exit_code(compare(changed(1.15))), 1);
  for (const double factor : {1.08, 1.0, 1.0 / 1.15}) EXPECT_EQ(exit_code(compare(changed(factor))), 0);
  EXPECT_EQ(found(compare(changed(1.08), {.effect = 0.05}), "it").finding, Finding::slower);
  EXPECT_EQ(found(compare(changed(1.15), {.effect = 0.2}), "it").finding, Finding::same);
}

// Of the hundred differences 56 are positive, most by a third: the median is, and the ranks prove nothing.
TEST(Comparison, SlowerByChanceIsUndecided) {
  std::vector<double> base;
  std::vector<double> now;
  for (int i = 0; i < 10; ++i) {
    const double close = 1.0 + 0.001 * i;
    base.push_back(close * (i < 3 ? 1.6 : 1.0));
    now.push_back(close * (i < 8 ? 1.3 : 0.9));
  }
  const Comparison comparison = compare(run_of({timed("it", base)}, {timed("it", now)}));
  EXPECT_GE(found(comparison, "it").ratio, 1.1);
  EXPECT_GT(found(comparison, "it").p_value, 0.01);
  EXPECT_EQ(found(comparison, "it").finding, Finding::undecided);
  EXPECT_EQ(exit_code(comparison), 2);
}

// 10 and 10 repetitions reach 1 / 184756, 3 and 3 one in 20; 10 pairs one in 1024.
TEST(Comparison, TooFewRepetitionsAreNoPass) {
  const Comparison comparison = compare(changed(2.0, 3));
  EXPECT_EQ(found(comparison, "it").finding, Finding::too_few);
  // Of four: 4 / C(2 n, n) <= 0.01 from n = 6 on (924; of 5 it is 252).
  EXPECT_THAT(found(comparison, "it").remark, HasSubstr("6 repetitions"));
  EXPECT_EQ(exit_code(comparison), 2);
  EXPECT_EQ(finding(changed(2.0, 6)), Finding::slower);
  EXPECT_EQ(finding(changed(1.0, 1)), Finding::too_few);
  EXPECT_EQ(exit_code(compare(changed(1.0, 1))), 2);
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

TEST(Comparison, FilesWithAggregatesAloneAreNoPass) {
  const Comparison comparison = compare(run_of({timed("it", {})}, {steady("it", 1.0, 10, 1)}));
  EXPECT_EQ(found(comparison, "it").finding, Finding::too_few);
  EXPECT_THAT(found(comparison, "it").remark, AllOf(HasSubstr("base"), HasSubstr("aggregates only")));
  EXPECT_EQ(exit_code(comparison), 2);
}

TEST(Comparison, BenchmarksOnOneSideAreReported) {
  const auto it = [](const std::string& name) { return steady(name, 1e-3, kRepetitions, 5); };
  const Comparison missing = compare(run_of({it("it")}, {}));
  EXPECT_EQ(found(missing, "it").finding, Finding::only_in_base);
  EXPECT_EQ(exit_code(missing), 2);
  const Comparison added = compare(run_of({}, {it("it")}));
  EXPECT_EQ(found(added, "it").finding, Finding::only_in_new);
  EXPECT_EQ(exit_code(added), 2);

  const Comparison renamed = compare(run_of({it("apply_fft/128")}, {it("apply_dcfft/128")}));
  EXPECT_EQ(exit_code(renamed), 2);
  EXPECT_THAT(found(renamed, "apply_fft/128").remark, HasSubstr("renamed to apply_dcfft/128?"));
  EXPECT_THAT(found(renamed, "apply_dcfft/128").remark, HasSubstr("renamed from apply_fft/128?"));
  const Comparison other = compare(run_of({it("apply_fft/128")}, {it("whole_solve/7")}));
  EXPECT_EQ(found(other, "apply_fft/128").remark, "");
  EXPECT_EQ(exit_code(compare(run_of({it("a")}, {it("b")}, 0))), 2);
}

TEST(Comparison, OrderIsTheBasesThenWhatIsNew) {
  const auto it = [](const std::string& name) { return steady(name, 1e-3, kRepetitions, 5); };
  const Comparison comparison = compare(run_of({it("b"), it("a")}, {it("new"), it("a"), it("b")}, 0));
  std::vector<std::string> names;
  for (const ComparedBenchmark& benchmark : comparison.benchmarks) names.push_back(benchmark.name);
  EXPECT_THAT(names, ElementsAre("b", "a", "new"));
}

TEST(Comparison, FailuresCountWhereTheyAreNew) {
  TimedBenchmark failed = timed("it", {});
  failed.error = "disagrees with its reference";
  const TimedBenchmark good = steady("it", 1e-3, kRepetitions, 1);
  const Comparison now = compare(run_of({good}, {failed}));
  EXPECT_EQ(found(now, "it").finding, Finding::failed);
  EXPECT_THAT(found(now, "it").remark, HasSubstr("disagrees with its reference"));
  EXPECT_EQ(exit_code(now), 1);
  for (const TimedBenchmark& other : {good, failed}) {
    const Comparison before = compare(run_of({failed}, {other}));
    EXPECT_EQ(found(before, "it").finding, Finding::not_timed);
    EXPECT_THAT(found(before, "it").remark, HasSubstr(other.error.empty() ? "in the base" : "in both"));
    EXPECT_EQ(exit_code(before), 2);
  }
  TimedBenchmark skipped = timed("it", {});
  skipped.skipped = "no GPU";
  const Comparison skip = compare(run_of({good}, {skipped}));
  EXPECT_EQ(found(skip, "it").finding, Finding::not_timed);
  EXPECT_THAT(found(skip, "it").remark, AllOf(HasSubstr("skipped"), HasSubstr("no GPU")));
  EXPECT_EQ(exit_code(skip), 2);
}

TEST(Comparison, NoTimePassesThatIsNone) {
  for (const double time : {std::nan(""), HUGE_VAL, 0.0, -1.0}) {
    TimedBenchmark bad = steady("it", 1e-3, kRepetitions, 1);
    bad.timings[4].real = time;
    const TimedBenchmark good = steady("it", 1e-3, kRepetitions, 2);
    EXPECT_EQ(exit_code(compare(run_of({good}, {bad}))), 1) << time;
    EXPECT_EQ(exit_code(compare(run_of({bad}, {good}))), 2) << time;
  }
}

TEST(Comparison, NothingComparedIsNoPass) { EXPECT_EQ(exit_code(Comparison{}), 2); }

TEST(Comparison, RulesThatMeanNothingAreRefused) {
  for (const double effect : {0.0, -0.1, std::nan("")}) {
    EXPECT_THROW(compare(steady_run(), {.effect = effect}), std::invalid_argument);
  }
  for (const double level : {0.0, 1.0, std::nan("")}) {
    EXPECT_THROW(compare(steady_run(), {.level = level}), std::invalid_argument);
  }
}

/// What stands in the way after a change to the files, one of which is slower by half.
std::string obstacle(const std::function<void(TwoFiles&)>& change, const ComparisonRules& rules = {}) {
  TwoFiles run = changed(1.5);
  change(run);
  const Comparison comparison = compare(run, rules);
  if (comparison.obstacles.empty()) {
    EXPECT_EQ(exit_code(comparison), 1);
    return "";
  }
  EXPECT_EQ(exit_code(comparison), 2);
  EXPECT_EQ(found(comparison, "it").finding, Finding::not_judged);
  EXPECT_NEAR(found(comparison, "it").ratio, 1.5, 0.02);  // the numbers stay
  return comparison.obstacles.front();
}

TEST(Obstacles, NoneBetweenTwoRunsOfOneQuietMachine) {
  EXPECT_EQ(obstacle([](TwoFiles&) {}), "");
}

TEST(Obstacles, DifferentMachines) {
  const std::vector<std::pair<std::string, std::function<void(TwoFiles&)>>> changes{
      {"num_cpus", [](TwoFiles& run) { run.now.context.cpus = 4; }},
      {"host_name", [](TwoFiles& run) { run.now.context.host_name = "elsewhere"; }},
      {"mhz_per_cpu", [](TwoFiles& run) { run.now.context.mhz *= 1.06; }},
      {"mhz_per_cpu", [](TwoFiles& run) { run.now.context.mhz = std::nan(""); }},
      {"caches", [](TwoFiles& run) { run.now.context.caches = {"L2 Unified 1048576 shared by 1"}; }}};
  for (const auto& [what, change] : changes) {
    EXPECT_THAT(obstacle(change), AllOf(HasSubstr("machines differ"), HasSubstr(what)));
    EXPECT_EQ(obstacle(change, {.same_machine = true}), "") << what;
  }
  EXPECT_EQ(obstacle([](TwoFiles& run) { run.now.context.mhz *= 1.04; }), "");
  EXPECT_EQ(obstacle([](TwoFiles& run) {  // one session is of one machine, whose clock may change
              run.base.context.session = run.now.context.session = "one";
              run.now.context.mhz *= 2.0;
            }),
            "");
}

TEST(Obstacles, DebugBuilds) {
  const auto library = [](TwoFiles& run) { run.base.context.library_build_type = "debug"; };
  EXPECT_THAT(obstacle(library), AllOf(HasSubstr("base.json"), HasSubstr("--debug-library")));
  EXPECT_EQ(obstacle(library, {.debug_library = true}), "");
  EXPECT_EQ(obstacle([](TwoFiles& run) {
              run.now.context.library_build_type = "debug";
              run.now.context.build_type = "release";
            }),
            "");
  const auto program = [](TwoFiles& run) { run.now.context.build_type = "Debug"; };
  EXPECT_THAT(obstacle(program, {.debug_library = true}),
              AllOf(HasSubstr("new.json"), HasSubstr("debug build")));
}

TEST(Obstacles, LoadThatTheRunDoesNotExplain) {
  for (const bool in_base : {true, false}) {
    const auto load = [&](double average, int threads) {
      return [=](TwoFiles& run) {
        Timings& timings = in_base ? run.base : run.now;
        timings.context.load_average[0] = average;
        timings.benchmarks.back().threads = threads;
      };
    };
    EXPECT_THAT(obstacle(load(5.1, 1)),
                AllOf(HasSubstr(in_base ? "base.json" : "new.json"), HasSubstr("loaded")));
    EXPECT_EQ(obstacle(load(4.9, 1)), "");
    EXPECT_EQ(obstacle(load(5.1, 2)), "");
  }
  EXPECT_EQ(obstacle([](TwoFiles& run) { run.now.context.load_average.clear(); }), "");
}

/// Takes longer by the clock, not by the processor's time.
void wait(TimedBenchmark& benchmark, double factor) {
  for (Timing& timing : benchmark.timings) timing.cpu = timing.real / factor;
}

TEST(Obstacles, MostBenchmarksWait) {
  const auto all_wait = [](double factor) {
    return [=](TwoFiles& files) {
      for (TimedBenchmark& benchmark : files.now.benchmarks) wait(benchmark, factor);
    };
  };
  EXPECT_THAT(obstacle(all_wait(1.6)), AllOf(HasSubstr("new.json"), HasSubstr("4 of 4")));
  EXPECT_THAT(obstacle([](TwoFiles& files) {
                for (TimedBenchmark& benchmark : files.base.benchmarks) wait(benchmark, 1.6);
              }),
              HasSubstr("base.json"));
  EXPECT_EQ(obstacle(all_wait(1.2)), "");
  EXPECT_EQ(obstacle(all_wait(20.0)), "");  // by their nature
  EXPECT_EQ(obstacle([](TwoFiles& files) {  // a sleep was put into two of four
              for (const int i : {0, 1}) wait(files.now.benchmarks[static_cast<std::size_t>(i)], 1.6);
            }),
            "");
  EXPECT_EQ(obstacle([&](TwoFiles& files) {  // the clock is the program's own, but of one
              all_wait(1.6)(files);
              for (Timings* const timings : {&files.base, &files.now}) {
                for (std::size_t i = 1; i < 4; ++i) timings->benchmarks[i].name += "/manual_time";
              }
            }),
            "");
}

// A second run holds nothing but what was slower: that all of it waits is no sign of load then.
TEST(Obstacles, WhatWaitedInTheFirstRunMayWaitInTheSecond) {
  TwoFiles first = steady_run();
  for (TimedBenchmark& benchmark : first.now.benchmarks) wait(benchmark, 1.6);
  const std::vector<std::string> waiting = compare(first).waiting;
  EXPECT_THAT(waiting, ElementsAre("steady/0", "steady/1", "steady/2"));
  EXPECT_EQ(exit_code(compare(first)), 2);
  EXPECT_EQ(exit_code(compare(first, {.waiting = waiting})), 0);
}

TEST(Obstacles, OneRunAgainstItself) {
  TwoFiles run = steady_run();
  run.now.benchmarks = run.base.benchmarks;
  const Comparison comparison = compare(run);
  EXPECT_THAT(comparison.obstacles, ElementsAre(HasSubstr("compared with itself")));
  EXPECT_EQ(exit_code(comparison), 2);
}

TEST(Obstacles, FrequencyScalingIsARemark) {
  TwoFiles run = steady_run();
  run.now.context.scaling = true;
  const Comparison comparison = compare(run);
  EXPECT_THAT(comparison.obstacles, IsEmpty());
  EXPECT_THAT(comparison.remarks, ElementsAre(AllOf(HasSubstr("new.json"), HasSubstr("frequency"))));
  EXPECT_EQ(exit_code(comparison), 0);
}

Comparison of_finding(Finding finding) {
  ComparedBenchmark one;
  one.name = "it";
  one.finding = finding;
  Comparison comparison;
  comparison.benchmarks = {one};
  return comparison;
}

TEST(SecondRun, OnlyWhatItConfirmsCounts) {
  const auto after = [](Finding first, Finding second) {
    return exit_code(confirm(of_finding(first), of_finding(second)));
  };
  EXPECT_EQ(after(Finding::slower, Finding::slower), 1);
  EXPECT_EQ(after(Finding::failed, Finding::failed), 1);
  for (const Finding first : {Finding::slower, Finding::failed, Finding::undecided}) {
    EXPECT_EQ(after(first, Finding::same), 0);
    EXPECT_EQ(after(first, Finding::quicker), 0);
    for (const Finding second : {Finding::undecided, Finding::not_judged, Finding::only_in_base,
                                 Finding::too_few, Finding::not_timed}) {
      EXPECT_EQ(after(first, second), 2);
    }
  }
  EXPECT_EQ(after(Finding::undecided, Finding::slower), 1);  // it is a test of its own
  EXPECT_EQ(after(Finding::failed, Finding::slower), 2);
  EXPECT_EQ(after(Finding::slower, Finding::failed), 2);
  EXPECT_EQ(exit_code(confirm(of_finding(Finding::slower), {})), 2);
  EXPECT_EQ(exit_code(confirm(of_finding(Finding::same), {})), 0);
  Comparison on_another_machine;
  on_another_machine.obstacles = {"the machines differ"};
  EXPECT_EQ(exit_code(confirm(of_finding(Finding::same), on_another_machine)), 2);
  const Comparison cleared = confirm(of_finding(Finding::slower), of_finding(Finding::same));
  EXPECT_THAT(cleared.benchmarks[0].remark, AllOf(HasSubstr("first run: slower"), HasSubstr("second: same")));
  Comparison first = of_finding(Finding::slower);
  Comparison second = first;
  first.benchmarks[0].p_value = 0.04;
  second.benchmarks[0].p_value = 0.002;
  EXPECT_EQ(confirm(first, second).benchmarks[0].p_value, 0.002);  // of the test that decided
  EXPECT_EQ(confirm(first, {}).benchmarks[0].p_value, 0.04);
}

}  // namespace
}  // namespace slipstick::bench
