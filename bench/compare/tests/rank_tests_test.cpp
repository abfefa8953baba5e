// Tests by ranks: against published tables, recurrences and full enumeration; intervals by how often they
// hold.

#include "bench/compare/rank_tests.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <tuple>

namespace slipstick::bench {
namespace {

using namespace ::testing;

struct Samples {
  std::vector<double> base;
  std::vector<double> now;
};

/// Values 1 to n + m, so dealt that `now` (of m) exceeds `base` (of n) in u pairs.
Samples samples_with(std::size_t u, std::size_t n, std::size_t m) {
  std::vector<std::size_t> places(m);
  std::iota(places.begin(), places.end(), std::size_t{0});
  for (std::size_t i = m; i-- > 0;) {
    const std::size_t step = std::min(u, n);
    places[i] += step;
    u -= step;
  }
  Samples samples;
  for (std::size_t value = 0; value < n + m; ++value) {
    const bool is_now = std::find(places.begin(), places.end(), value) != places.end();
    (is_now ? samples.now : samples.base).push_back(static_cast<double>(value + 1));
  }
  return samples;
}

Shift shift_with(std::size_t u, std::size_t n, std::size_t m) {
  const Samples samples = samples_with(u, n, m);
  return rank_sum_shift(samples.base, samples.now);
}

/// 1 to n, so signed that the positive ones sum to t.
std::vector<double> differences_with(std::size_t t, std::size_t n) {
  std::vector<double> differences(n);
  for (std::size_t rank = n; rank > 0; --rank) {
    const bool positive = rank <= t;
    if (positive) t -= rank;
    differences[rank - 1] = (positive ? 1.0 : -1.0) * static_cast<double>(rank);
  }
  return differences;
}

/// Orders of n and m values with u pairs in which the second is larger: by whom the largest value belongs to
/// (Mann and Whitney 1947).
double orders(int u, int n, int m) {
  static std::map<std::tuple<int, int, int>, double> known;
  if (u < 0 || u > n * m) return 0.0;
  if (n == 0 || m == 0) return 1.0;
  const auto found = known.find({u, n, m});
  if (found != known.end()) return found->second;
  return known[{u, n, m}] = orders(u - n, n, m - 1) + orders(u, n - 1, m);
}

double chance_of_at_most(int u, int n, int m) {
  double some = 0.0;
  double all = 0.0;
  for (int v = 0; v <= n * m; ++v) {
    all += orders(v, n, m);
    if (v <= u) some += orders(v, n, m);
  }
  return some / all;
}

TEST(RankSum, CountsAsTheRecurrenceDoes) {
  for (const auto& [n, m] : {std::pair(3, 9), std::pair(10, 10), std::pair(30, 30), std::pair(7, 40)}) {
    for (const int u : {0, n, n * m / 4, n * m / 2, n * m}) {
      const Shift shift =
          shift_with(static_cast<std::size_t>(u), static_cast<std::size_t>(n), static_cast<std::size_t>(m));
      EXPECT_NEAR(shift.p_negative / chance_of_at_most(u, n, m), 1.0, 1e-11) << n << ' ' << m << ' ' << u;
      EXPECT_NEAR(shift.p_positive / chance_of_at_most(n * m - u, n, m), 1.0, 1e-11);
    }
  }
}

// By hand: mid-ranks 1, 2.5, 2.5, 4, pairs sum to 3.5 (twice), 5 (twice) and 6.5 (twice).
TEST(RankSum, CountsTiesAsTheyAre) {
  const Shift shift = rank_sum_shift(std::vector{1.0, 2.0}, std::vector{2.0, 3.0});
  EXPECT_DOUBLE_EQ(shift.p_positive, 2.0 / 6.0);
  EXPECT_DOUBLE_EQ(shift.p_negative, 1.0);
  EXPECT_DOUBLE_EQ(rank_sum_shift(std::vector{1.0, 3.0}, std::vector{2.0, 2.0}).p_positive, 4.0 / 6.0);
}

// Critical values of the smaller sum, one-sided 2.5 % (Wilcoxon and Wilcox 1964).
TEST(SignedRank, HasThePublishedCriticalValues) {
  const std::vector<std::pair<std::size_t, std::size_t>> table{
      {6, 0}, {7, 2}, {8, 3}, {9, 5}, {10, 8}, {12, 13}, {15, 25}, {20, 52}, {25, 89}, {30, 137}};
  for (const auto& [n, critical] : table) {
    EXPECT_LE(signed_rank_shift(differences_with(critical, n)).p_negative, 0.025) << n;
    EXPECT_GT(signed_rank_shift(differences_with(critical + 1, n)).p_negative, 0.025) << n;
    const std::size_t all = n * (n + 1) / 2;
    EXPECT_LE(signed_rank_shift(differences_with(all - critical, n)).p_positive, 0.025) << n;
    EXPECT_GT(signed_rank_shift(differences_with(all - critical - 1, n)).p_positive, 0.025) << n;
  }
}

// By hand: the zero is left out, and 1, 1, -1, 2 have the ranks 2, 2, 2, 4. The positive ones sum to 8, and
// to as much or more in four of the sixteen ways to sign them.
TEST(SignedRank, CountsTiesAsTheyAreAndNoZeros) {
  const Shift shift = signed_rank_shift(std::vector{0.0, 1.0, 1.0, -1.0, 2.0});
  EXPECT_DOUBLE_EQ(shift.p_positive, 4.0 / 16.0);
  EXPECT_DOUBLE_EQ(shift.p_negative, 15.0 / 16.0);
}

/// Chances that signed ranks 1 to n sum to t or less, by t, by counting.
std::vector<double> counted_signed_ranks(std::size_t n) {
  std::vector<double> chances(n * (n + 1) / 2 + 1, 0.0);
  chances[0] = 1.0;
  for (std::size_t rank = 1; rank <= n; ++rank) {
    for (std::size_t s = chances.size(); s-- > 0;) {
      chances[s] = 0.5 * (chances[s] + (s >= rank ? chances[s - rank] : 0.0));
    }
  }
  std::partial_sum(chances.begin(), chances.end(), chances.begin());
  return chances;
}

// Tails of the sums are thinner than normal ones: beyond counting, chances are up to a fifth too large, which
// is the safe side.
TEST(RankTests, TakeTheNormalDistributionBeyondCounting) {
  std::vector<std::pair<double, double>> cases;  // found and exact values
  const int n = 31;
  for (const int u : {481, 420, 360, 300, 262}) {
    const Shift shift = shift_with(static_cast<std::size_t>(u), 31, 31);
    cases.emplace_back(shift.p_negative, chance_of_at_most(u, n, n));
    EXPECT_DOUBLE_EQ(shift_with(static_cast<std::size_t>(n * n - u), 31, 31).p_positive, shift.p_negative);
  }
  const std::vector<double> counted = counted_signed_ranks(61);
  for (const std::size_t t : {945U, 800U, 700U, 600U, 540U})
    cases.emplace_back(signed_rank_shift(differences_with(t, 61)).p_negative, counted[t]);
  for (const auto& [found, exact] : cases) {
    EXPECT_GT(found, 0.99 * exact) << exact;
    EXPECT_LT(found, (exact > 0.02 ? 1.01 : 1.2) * exact) << exact;
  }
}

TEST(RankTests, SeparatedSamplesHaveTheLeastChance) {
  for (const auto& [n, m, choices] : {std::tuple(10U, 10U, 184756.0), std::tuple(3U, 5U, 56.0)}) {
    EXPECT_NEAR(least_rank_sum_chance(n, m) * choices, 1.0, 1e-14);
    EXPECT_NEAR(shift_with(n * m, n, m).p_positive * choices, 1.0, 1e-12);
    EXPECT_DOUBLE_EQ(shift_with(n * m, n, m).p_negative, 1.0);
  }
  for (const std::size_t n : {std::size_t{10}, kMaxCounted}) {  // as many as are counted
    const double chance = std::exp2(-static_cast<double>(n));
    EXPECT_DOUBLE_EQ(least_signed_rank_chance(n), chance);
    EXPECT_DOUBLE_EQ(signed_rank_shift(differences_with(n * (n + 1) / 2, n)).p_positive, chance);
  }
  EXPECT_DOUBLE_EQ(signed_rank_shift(std::vector<double>(5, 0.0)).p_positive, 1.0);
  EXPECT_DOUBLE_EQ(signed_rank_shift(std::vector<double>(5, 0.0)).p_negative, 1.0);
}

// By hand: means of two of -1, 2, 3 are -1, 0.5, 1, 2, 2.5, 3; differences of {1, 2} from {4, 8} 3, 7, 2, 6.
// There is no interval where none reaches 95 %.
TEST(HodgesLehmann, IsTheMedianOfMeansOrDifferencesWithItsInterval) {
  using Values = std::vector<double>;
  for (const auto& [small, estimate] : {std::pair(signed_rank_shift(Values{-1.0, 2.0, 3.0}), 1.5),
                                        std::pair(signed_rank_shift(Values{1.0, 2.0, 3.0, 4.0, 5.0}), 3.0),
                                        std::pair(rank_sum_shift(Values{1.0, 2.0}, Values{4.0, 8.0}), 4.5)}) {
    EXPECT_DOUBLE_EQ(small.estimate, estimate);
    EXPECT_TRUE(std::isnan(small.low) && std::isnan(small.high));
  }
  const Shift paired = signed_rank_shift(differences_with(21, 6));
  EXPECT_THAT((std::array{paired.estimate, paired.low, paired.high}), ElementsAre(3.5, 1.0, 6.0));
  const Shift independent = rank_sum_shift(Values{1.0, 2.0, 3.0, 4.0}, Values{11.0, 12.0, 13.0, 14.0});
  EXPECT_THAT((std::array{independent.estimate, independent.low, independent.high}),
              ElementsAre(10.0, 7.0, 13.0));
}

/// The share of hits, within three standard deviations.
void expect_share(int hits, int draws, double share) {
  EXPECT_NEAR(static_cast<double>(hits) / draws, share, 3.0 * std::sqrt(share * (1.0 - share) / draws));
}

// The chance of an interval is known whatever the distribution: 1 - 2 P(U <= 23) of 10 and 10, 1 - 2 P(T <=
// 13) of 12 pairs.
TEST(HodgesLehmann, IntervalsHoldAsOftenAsTheySay) {
  std::mt19937_64 generator(9);
  std::lognormal_distribution<double> skew(0.0, 0.5);
  std::student_t_distribution<double> heavy(2.0);  // symmetric, as signed ranks ask
  constexpr int kDraws = 4000;
  constexpr double kShift = 0.7;
  int independent = 0;
  int paired = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<double> base(10);
    std::vector<double> now(10);
    std::vector<double> differences(12);
    for (double& x : base) x = skew(generator);
    for (double& x : now) x = kShift + skew(generator);
    for (double& x : differences) x = kShift + heavy(generator);
    const Shift one = rank_sum_shift(base, now);
    const Shift two = signed_rank_shift(differences);
    independent += one.low <= kShift && kShift <= one.high ? 1 : 0;
    paired += two.low <= kShift && kShift <= two.high ? 1 : 0;
  }
  expect_share(independent, kDraws, 1.0 - 2.0 * chance_of_at_most(23, 10, 10));
  expect_share(paired, kDraws, 1.0 - 2.0 * 87.0 / 4096.0);  // 87 of 4096 sign patterns sum to 13 or less
}

// Four chances, by hand: 0.005 x 4, 0.01 x 3, 0.03 x 2, then 0.04 x 1, which may not be below the one before.
TEST(Holm, MultipliesByThoseThatAreLeft) {
  const auto near = [](double x) { return DoubleNear(x, 1e-15); };
  EXPECT_THAT(holm({0.01, 0.04, 0.03, 0.005}), ElementsAre(near(0.03), near(0.06), near(0.06), near(0.02)));
  EXPECT_THAT(holm({0.6, 0.7}), ElementsAre(1.0, 1.0));
  EXPECT_TRUE(holm({}).empty());
}

}  // namespace
}  // namespace slipstick::bench
