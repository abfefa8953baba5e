// Whether a change of the size that a report states is found as often as it says.

#include <gtest/gtest.h>

#include <random>

#include "bench/compare/second_run.hpp"
#include "bench/compare/tests/made_timings.hpp"

namespace slipstick::bench {
namespace {

struct Case {
  bool paired;
  double level;  ///< of one benchmark alone
  std::size_t repetitions;
  Noise noise;
  std::size_t second_run = 0;
  double effect = 0.1;
};

/// The part found of 500 changes, each as large as a comparison of equal builds has just stated.
double part_found(const Case& each, std::mt19937_64& generator) {
  const ComparisonRules rules{.effect = each.effect, .level = each.level, .second_run = each.second_run};
  constexpr int kComparisons = 500;
  int found = 0;
  for (int i = 0; i < kComparisons; ++i) {
    const auto timed = [&](std::size_t times, double factor) {
      return draw(generator, 1, times * each.repetitions, each.paired, each.noise, 1, factor);
    };
    const TwoTimings equal = timed(1, 1.0);
    Comparison stated = compare(equal, rules);
    state_power(stated, equal, rules);
    const double factor = stated.benchmarks.front().smallest_found;
    EXPECT_GT(factor, 1.0 + each.effect);
    Comparison seen = compare(timed(1, factor), rules);
    if (each.second_run > 0 && !suspicious(seen).empty()) {
      seen = confirm(seen, compare(timed(each.second_run, factor), rules));
    }
    found += seen.benchmarks.front().finding == Finding::slower ? 1 : 0;
  }
  return found / static_cast<double>(kComparisons);
}

TEST(Power, AStatedChangeIsFoundNineTimesInTen) {
  std::mt19937_64 generator(21);
  for (const Case& each : {Case{true, 0.01, 12, {.scatter = 0.03, .outliers = 0.0}},
                           Case{true, 0.01, 12, {.scatter = 0.02, .outliers = 0.02, .drift = 0.05}, 2},
                           Case{true, 0.01, 10, {.scatter = 0.06, .outliers = 0.05}, 2},
                           Case{true, 0.003, 16, {.scatter = 0.1, .outliers = 0.0}, 0, 0.02},
                           Case{false, 0.01, 10, {.scatter = 0.03, .outliers = 0.0}},
                           Case{false, 0.003, 14, {.scatter = 0.08, .outliers = 0.05}}}) {
    const double part = part_found(each, generator);
    EXPECT_GE(part, 0.85) << each.paired << each.repetitions << ", " << each.noise.scatter;
    EXPECT_LE(part, 0.97) << each.paired << each.repetitions << ", " << each.noise.scatter;
  }
}

TEST(Power, RepetitionsThatCanShowNothingFindNothing) {
  std::mt19937_64 generator(22);
  const TwoTimings few = draw(generator, 1, 5, true, {});
  const ComparisonReport report = compare_twice(few, {}, {});
  EXPECT_EQ(report.comparison.benchmarks.front().smallest_found, std::numeric_limits<double>::infinity());
}

TEST(Power, ASmallerEffectIsFoundFromASmallerChangeOn) {
  std::mt19937_64 generator(23);
  const TwoTimings files = draw(generator, 1, 20, true, {.scatter = 0.01, .outliers = 0.0});
  const auto smallest = [&](double effect) {
    return compare_twice(files, {.effect = effect}, {}).comparison.benchmarks[0].smallest_found;
  };
  EXPECT_LT(smallest(0.05), 1.10);
  EXPECT_GT(smallest(0.10), 1.10);
}

TEST(Power, AnIntervalAboveOneIsNotCalledTheSame) {
  std::mt19937_64 generator(24);
  const TwoTimings files = draw(generator, 1, 20, true, {.scatter = 0.02, .outliers = 0.0}, 1, 1.06);
  const ComparisonReport report = compare_twice(files, {}, {});
  EXPECT_NE(comparison_text(report).find("slower, below what counts"), std::string::npos);
  EXPECT_EQ(exit_code(report.comparison), 0);
}

}  // namespace
}  // namespace slipstick::bench
