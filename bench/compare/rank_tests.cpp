#include "bench/compare/rank_tests.hpp"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_sf_gamma.h>
#include <gsl/gsl_statistics_double.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

namespace slipstick::bench {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
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

/// The distribution of the sum of ranks that chance picks, all choices equally likely.
class RankSum {
 public:
  /// picked: choices of this number; none: of any number.
  RankSum(std::span<const std::size_t> ranks, std::optional<std::size_t> picked) {
    const auto count = static_cast<double>(ranks.size());
    const double total = static_cast<double>(sum(ranks));
    const double part = picked ? static_cast<double>(*picked) / count : 0.5;
    mean_ = part * total;
    double squares = 0.0;  // about the mean where their number is given, else about zero
    for (const std::size_t rank : ranks) {
      squares += std::pow(static_cast<double>(rank) - (picked ? total / count : 0.0), 2);
    }
    variance_ = part * (1.0 - part) * squares * (picked ? count / (count - 1.0) : 1.0);
    if (ranks.size() <= kMaxCounted) chances_ = counted(ranks, picked);
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
  static std::vector<double> counted(std::span<const std::size_t> ranks, std::optional<std::size_t> picked) {
    const std::size_t total = sum(ranks);
    const std::size_t most = picked.value_or(ranks.size());
    // ways[j][s]: choices of j ranks that sum to s.
    std::vector<std::vector<double>> ways(most + 1, std::vector<double>(total + 1, 0.0));
    ways[0][0] = 1.0;
    for (std::size_t i = 0; i < ranks.size(); ++i) {
      for (std::size_t j = std::min(i + 1, most); j > 0; --j) {
        for (std::size_t s = ranks[i]; s <= total; ++s) ways[j][s] += ways[j - 1][s - ranks[i]];
      }
    }
    std::vector<double> chances = ways[most];
    for (std::size_t j = 0; !picked && j < most; ++j) {
      std::ranges::transform(chances, ways[j], chances.begin(), std::plus<>());
    }
    const double all = std::accumulate(chances.begin(), chances.end(), 0.0);
    for (double& chance : chances) chance /= all;
    return chances;
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

/// The distribution of the rank sum, its observed value, and the sorted means or differences, whose median is
/// the estimate. Beyond either end of the interval lie as many of them as the rank sum has values in the
/// tail, if there are no ties.
Shift shift_of(std::vector<double> values, const RankSum& chance, std::size_t observed,
               const RankSum& without_ties, std::size_t least) {
  std::ranges::sort(values);
  std::size_t beyond = 0;
  while (2 * beyond < values.size() && without_ties.at_most(least + 2 * beyond) <= kTail) ++beyond;
  return {.estimate = gsl_stats_median_from_sorted_data(values.data(), 1, values.size()),
          .low = beyond == 0 ? kNoNumber : values[beyond - 1],
          .high = beyond == 0 ? kNoNumber : values[values.size() - beyond],
          .p_positive = chance.at_least(observed),
          .p_negative = chance.at_most(observed)};
}

}  // namespace

Shift signed_rank_shift(std::span<const double> differences) {
  std::vector<double> sizes;
  std::vector<bool> positive;
  std::vector<double> means;  // of each two, also of one with itself
  for (std::size_t i = 0; i < differences.size(); ++i) {
    for (const double other : differences.subspan(i)) means.push_back(0.5 * (differences[i] + other));
    if (differences[i] == 0.0) continue;
    sizes.push_back(std::abs(differences[i]));
    positive.push_back(differences[i] > 0.0);
  }
  const std::vector<std::size_t> ranks = doubled_ranks(sizes);
  std::size_t observed = 0;
  for (std::size_t i = 0; i < ranks.size(); ++i) observed += positive[i] ? ranks[i] : 0;
  return shift_of(std::move(means), RankSum(ranks, {}), observed,
                  RankSum(doubled_ranks_without_ties(differences.size()), {}), 0);
}

Shift rank_sum_shift(std::span<const double> base, std::span<const double> now) {
  std::vector<double> pooled(now.begin(), now.end());
  pooled.insert(pooled.end(), base.begin(), base.end());
  std::vector<double> differences;
  for (const double later : now) {
    for (const double earlier : base) differences.push_back(later - earlier);
  }
  const std::vector<std::size_t> ranks = doubled_ranks(pooled);
  return shift_of(std::move(differences), RankSum(ranks, now.size()), sum(std::span(ranks).first(now.size())),
                  RankSum(doubled_ranks_without_ties(ranks.size()), now.size()),
                  now.size() * (now.size() + 1));
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
