#include "bench/compare/rank_tests.hpp"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_sf_gamma.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "bench/timing/median.hpp"

namespace slipstick::bench {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Chance beyond either end of a 95 % interval.
constexpr double kTail = 0.025;

/// Twice the mid-ranks, which are whole numbers, in the order of the values.
std::vector<std::size_t> doubled_ranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return values[i]; });
  std::vector<std::size_t> ranks(values.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first + 1;
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    for (std::size_t i = first; i < end; ++i) ranks[order[i]] = first + end + 1;
    first = end;
  }
  return ranks;
}

std::vector<std::size_t> doubled_ranks_without_ties(std::size_t count) {
  std::vector<std::size_t> ranks(count, 2);
  std::partial_sum(ranks.begin(), ranks.end(), ranks.begin());
  return ranks;
}

std::size_t sum(std::span<const std::size_t> ranks) {
  return std::accumulate(ranks.begin(), ranks.end(), std::size_t{0});
}

/// The distribution of the sum of some ranks that chance picks.
class RankSum {
 public:
  /// Each rank is picked or not, both equally likely.
  static RankSum of_any(std::span<const std::size_t> ranks) {
    const std::size_t largest = sum(ranks);
    RankSum distribution;
    distribution.mean_ = 0.5 * static_cast<double>(largest);
    for (const std::size_t rank : ranks) distribution.variance_ += 0.25 * static_cast<double>(rank * rank);
    if (ranks.size() > kMaxCounted) return distribution;
    std::vector<double>& chances = distribution.chances_;
    chances.assign(largest + 1, 0.0);
    chances[0] = 1.0;
    std::size_t reached = 0;
    for (const std::size_t rank : ranks) {
      reached += rank;
      for (std::size_t s = reached + 1; s-- > 0;) {
        chances[s] = 0.5 * (chances[s] + (s >= rank ? chances[s - rank] : 0.0));
      }
    }
    return distribution;
  }

  /// `picked` of the ranks are picked, all choices equally likely.
  static RankSum of_choice(std::span<const std::size_t> ranks, std::size_t picked) {
    const auto count = static_cast<double>(ranks.size());
    const double mean = static_cast<double>(sum(ranks)) / count;
    double squares = 0.0;
    for (const std::size_t rank : ranks) squares += std::pow(static_cast<double>(rank) - mean, 2);
    RankSum distribution;
    distribution.mean_ = static_cast<double>(picked) * mean;
    distribution.variance_ =
        static_cast<double>(picked * (ranks.size() - picked)) / (count * (count - 1.0)) * squares;
    if (ranks.size() <= kMaxCounted) distribution.chances_ = count_choices(ranks, picked);
    return distribution;
  }

  double at_most(std::size_t value) const {
    if (chances_.empty()) return normal(static_cast<double>(value) - mean_);
    return std::min(1.0, std::accumulate(chances_.begin(), chances_.begin() + offset(value + 1), 0.0));
  }

  double at_least(std::size_t value) const {
    if (chances_.empty()) return normal(mean_ - static_cast<double>(value));
    return std::min(1.0, std::accumulate(chances_.begin() + offset(value), chances_.end(), 0.0));
  }

 private:
  static std::vector<double> count_choices(std::span<const std::size_t> ranks, std::size_t picked) {
    std::vector<std::size_t> sorted(ranks.begin(), ranks.end());
    std::ranges::sort(sorted);
    const std::size_t largest = sum(std::span(sorted).last(picked));
    const bool even = std::ranges::all_of(sorted, [](std::size_t rank) { return rank % 2 == 0; });
    const std::size_t step = even ? 2 : 1;
    // ways[j][s]: choices of j ranks that sum to s.
    std::vector<std::vector<double>> ways(picked + 1, std::vector<double>(largest + 1, 0.0));
    ways[0][0] = 1.0;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      for (std::size_t j = std::min(i + 1, picked); j > 0; --j) {
        for (std::size_t s = sorted[i]; s <= largest; s += step) ways[j][s] += ways[j - 1][s - sorted[i]];
      }
    }
    const double all = std::accumulate(ways[picked].begin(), ways[picked].end(), 0.0);
    for (double& way : ways[picked]) way /= all;
    return ways[picked];
  }

  /// Chance of a deviation at most this far above the mean. Doubled ranks are two apart; half of that is the
  /// correction for continuity.
  double normal(double deviation) const {
    if (!(variance_ > 0.0)) return 1.0;
    return gsl_cdf_ugaussian_P((deviation + 1.0) / std::sqrt(variance_));
  }

  std::ptrdiff_t offset(std::size_t value) const {
    return static_cast<std::ptrdiff_t>(std::min(value, chances_.size()));
  }

  std::vector<double> chances_;  ///< by value; empty where there are too many ranks to count
  double mean_ = 0.0;
  double variance_ = 0.0;
};

/// How many of all differences (or means of two) are beyond an end of the interval: as many as the statistic,
/// from its least value on, stays in the tail; `least` is that value, doubled.
std::size_t count_beyond(const RankSum& without_ties, std::size_t least, std::size_t count, double tail) {
  std::size_t beyond = 0;
  while (2 * beyond < count && without_ties.at_most(least + 2 * beyond) <= tail) ++beyond;
  return beyond;
}

/// Sets estimate and interval.
void set_estimate(Shift& shift, const std::vector<double>& sorted, std::size_t place) {
  shift.estimate = median_of_sorted(sorted);
  shift.low = place == 0 ? -kInfinity : sorted[place - 1];
  shift.high = place == 0 ? kInfinity : sorted[sorted.size() - place];
}

void require_numbers(std::span<const double> sample) {
  const bool finite = std::all_of(sample.begin(), sample.end(), [](double x) { return std::isfinite(x); });
  if (sample.empty() || !finite) throw std::invalid_argument("ranks are of finite numbers, one at least");
}

}  // namespace

std::vector<double> sorted_means(std::span<const double> differences) {
  std::vector<double> means;
  for (std::size_t i = 0; i < differences.size(); ++i) {
    for (std::size_t j = i; j < differences.size(); ++j)
      means.push_back(0.5 * (differences[i] + differences[j]));
  }
  std::ranges::sort(means);
  return means;
}

std::vector<double> sorted_differences(std::span<const double> base, std::span<const double> now) {
  std::vector<double> differences;
  for (const double later : now) {
    for (const double earlier : base) differences.push_back(later - earlier);
  }
  std::ranges::sort(differences);
  return differences;
}

std::size_t signed_rank_place(std::size_t n, double level) {
  return count_beyond(RankSum::of_any(doubled_ranks_without_ties(n)), 0, n * (n + 1) / 2, level);
}

std::size_t rank_sum_place(std::size_t base, std::size_t now, double level) {
  const RankSum choice = RankSum::of_choice(doubled_ranks_without_ties(base + now), now);
  return count_beyond(choice, now * (now + 1), base * now, level);
}

Shift signed_rank_shift(std::span<const double> differences) {
  require_numbers(differences);
  std::vector<double> sizes;
  std::vector<bool> positive;
  for (const double difference : differences) {
    if (difference == 0.0) continue;
    sizes.push_back(std::abs(difference));
    positive.push_back(difference > 0.0);
  }
  const std::vector<std::size_t> ranks = doubled_ranks(sizes);
  std::size_t observed = 0;
  for (std::size_t i = 0; i < ranks.size(); ++i) observed += positive[i] ? ranks[i] : 0;
  const RankSum chance = RankSum::of_any(ranks);
  Shift shift;
  shift.p_positive = chance.at_least(observed);
  shift.p_negative = chance.at_most(observed);
  set_estimate(shift, sorted_means(differences), signed_rank_place(differences.size(), kTail));
  return shift;
}

Shift rank_sum_shift(std::span<const double> base, std::span<const double> now) {
  require_numbers(base);
  require_numbers(now);
  std::vector<double> pooled(now.begin(), now.end());
  pooled.insert(pooled.end(), base.begin(), base.end());
  const std::vector<std::size_t> ranks = doubled_ranks(pooled);
  const std::size_t observed = sum(std::span(ranks).first(now.size()));
  const RankSum chance = RankSum::of_choice(ranks, now.size());
  Shift shift;
  shift.p_positive = chance.at_least(observed);
  shift.p_negative = chance.at_most(observed);
  set_estimate(shift, sorted_differences(base, now), rank_sum_place(base.size(), now.size(), kTail));
  return shift;
}

double least_signed_rank_chance(std::size_t n) { return std::pow(0.5, static_cast<double>(n)); }

double least_rank_sum_chance(std::size_t n, std::size_t m) {
  return 1.0 / gsl_sf_choose(static_cast<unsigned>(n + m), static_cast<unsigned>(n));
}

std::vector<double> holm(const std::vector<double>& chances) {
  std::vector<std::size_t> order(chances.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return chances[i]; });
  std::vector<double> corrected(chances.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    largest = std::max(largest, static_cast<double>(order.size() - i) * chances[order[i]]);
    corrected[order[i]] = std::min(1.0, largest);
  }
  return corrected;
}

}  // namespace slipstick::bench
