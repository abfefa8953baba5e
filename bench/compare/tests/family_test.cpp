// Of many benchmarks one looks changed by chance: how their number counts, by hand.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "bench/compare/comparison.hpp"
#include "bench/compare/tests/made_timings.hpp"

namespace slipstick::bench {
namespace {

/// A benchmark of 6 and 6 repetitions, its new times `factor` times the base's but for one pair of all 36
/// that stands the other way round: the chance of ranks as low (as high) is 2 / C(12, 6) = 2/924. Beside
/// others, which are steady.
ComparedBenchmark all_but_one_pair(double factor, int others) {
  std::vector<double> base;
  std::vector<double> now;
  for (int i = 0; i < 6; ++i) {
    base.push_back(1.0 + 0.001 * i);
    now.push_back(factor * (1.0 + 0.001 * i));
  }
  const bool quicker = factor < 1.0;
  (quicker ? now.back() : now.front()) = quicker ? 1.0005 : 1.0045;
  Timings before = file_of("base.json", {timed("it", base)});
  Timings after = file_of("new.json", {timed("it", now)});
  for (int i = 0; i < others; ++i) {
    before.benchmarks.push_back(steady("steady/" + std::to_string(i), 1e-3, 10, 100 + i));
    after.benchmarks.push_back(steady("steady/" + std::to_string(i), 1e-3, 10, 200 + i));
  }
  return compare(before, after).benchmarks.front();
}

// Holm (1979): of m benchmarks the least chance counts m times. 4 times 2/924 is below the level of 0.01, 5
// times is above, though 2/924 itself is far below; and 5/924, which separated samples would have given,
// would have done.
TEST(Family, CountsTheLeastChanceAsOftenAsItHasMembersWhicheverWayTimesChange) {
  for (const double factor : {0.8, 1.25}) {
    const ComparedBenchmark of_four = all_but_one_pair(factor, 3);
    EXPECT_NEAR(of_four.p_value, 8.0 / 924.0, 1e-12);
    EXPECT_EQ(of_four.finding, factor < 1.0 ? Finding::quicker : Finding::slower);
    const ComparedBenchmark of_five = all_but_one_pair(factor, 4);
    EXPECT_NEAR(of_five.p_value, 10.0 / 924.0, 1e-12);
    EXPECT_EQ(of_five.finding, factor < 1.0 ? Finding::same : Finding::undecided);
  }
}

}  // namespace
}  // namespace slipstick::bench
