#pragma once

#include <cstddef>
#include <span>
#include <vector>

/// Tests by ranks and the estimates that belong to them: nothing is assumed of the distribution of times.
namespace slipstick::bench {

/// How far one sample lies above another.
struct Shift {
  double estimate = 0.0;  ///< Hodges and Lehmann's (1963)
  double low = 0.0;       ///< its 95 % interval; NaN where the samples are too small for one
  double high = 0.0;
  double p_positive = 1.0;  ///< chance of ranks as high as these or higher if there is no shift
  double p_negative = 1.0;  ///< of ranks as low or lower
};

/// The shift of differences of pairs by Wilcoxon's signed ranks (1945), zeros left out. Samples are finite
/// numbers, one at least.
Shift signed_rank_shift(std::span<const double> differences);

/// The shift of `now` over `base`, independent samples, by Mann and Whitney's test (1947). Both tests count
/// all arrangements of the ranks, ties as they are (mid-ranks), up to kMaxCounted numbers; beyond they take
/// the normal distribution with corrections for ties and continuity.
Shift rank_sum_shift(std::span<const double> base, std::span<const double> now);
inline constexpr std::size_t kMaxCounted = 60;

/// The smallest possible chance for this number of values: 2^-n; one in all choices of n of n + m.
double least_signed_rank_chance(std::size_t n);
double least_rank_sum_chance(std::size_t n, std::size_t m);

/// Chances corrected for their number, in their order: one that stays at a level or below is significant at
/// that level over all together (Holm 1979).
std::vector<double> holm(const std::vector<double>& chances);

}  // namespace slipstick::bench
