#include "bench/compare/power.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "bench/compare/rank_tests.hpp"
#include "bench/timing/median.hpp"

namespace slipstick::bench {
namespace {

using Sample = std::vector<double>;

constexpr int kDraws = 400;  ///< so that 0.9 is known to 0.015
constexpr int kFound = 360;

/// The differences of a sample from its median, widened: so few numbers scatter less about their own centre
/// than the next ones will.
Sample residuals(Sample sample) {
  const auto freedom = static_cast<double>(sample.size()) - 1.0;
  const double wider = std::sqrt(1.0 + 1.0 / freedom);
  const double centre = median(sample);
  for (double& value : sample) value = wider * (value - centre);
  return sample;
}

Sample drawn(const Sample& from, std::size_t count, std::mt19937_64& generator) {
  Sample sample(count);
  for (double& value : sample) value = from[generator() % from.size()];
  return sample;
}

Sample all_of(const Sample& base, const Sample& now, bool paired) {
  return paired ? sorted_means(now) : sorted_differences(base, now);
}

/// The samples to draw from: differences of pairs, or both sides.
struct Scatter {
  bool paired;
  Sample base;  ///< empty where they are paired
  Sample now;
};

/// So many times the repetitions, drawn again and again.
class Run {
 public:
  /// level: 0: the change need not be significant.
  Run(const Scatter& scatter, std::size_t times, double effect, double level)
      : scatter_(scatter),
        base_(times * scatter.base.size()),
        now_(times * scatter.now.size()),
        effect_(effect) {
    if (level > 0.0)
      place_ = scatter.paired ? signed_rank_place(now_, level) : rank_sum_place(base_, now_, level);
    can_show_ = level == 0.0 || place_ > 0;
  }

  /// The logarithm of the ratio that one draw needs so that it is found; width: over the observed scatter.
  double needed(double width, std::mt19937_64& generator) const {
    if (!can_show_) return std::numeric_limits<double>::infinity();
    const Sample base = drawn(scatter_.base, base_, generator);
    const Sample sorted = all_of(base, drawn(scatter_.now, now_, generator), scatter_.paired);
    const double needed = std::log1p(effect_) - width * median_of_sorted(sorted);
    return place_ > 0 ? std::max(needed, -width * sorted[place_ - 1]) : needed;
  }

 private:
  const Scatter& scatter_;
  std::size_t base_, now_;
  double effect_;
  std::size_t place_ = 0;
  bool can_show_;
};

}  // namespace

double smallest_found(std::span<const double> base, std::span<const double> now, bool paired,
                      const Search& search) {
  const std::size_t pairs = std::min(base.size(), now.size());
  if (pairs < 2) return std::numeric_limits<double>::quiet_NaN();
  Scatter scatter{.paired = paired, .base = {}, .now = {}};
  if (paired) {
    for (std::size_t i = 0; i < pairs; ++i) scatter.now.push_back(now[i] - base[i]);
  } else {
    scatter.base = residuals({base.begin(), base.end()});
    scatter.now.assign(now.begin(), now.end());
  }
  scatter.now = residuals(std::move(scatter.now));
  const double shift = median_of_sorted(all_of(scatter.base, scatter.now, paired));
  for (double& value : scatter.now) value -= shift;  // equal by the estimate that is drawn for
  const bool twice = search.second_run > 0;
  const Run first(scatter, 1, search.effect, twice ? 0.0 : search.level);
  const Run second(scatter, std::max<std::size_t>(search.second_run, 1), search.effect, search.level);
  std::mt19937_64 generator(1979);
  const auto freedom = static_cast<double>(pairs - 1);
  std::chi_squared_distribution<double> chi_squared(freedom);  // how well so few numbers know their scatter
  Sample shifts(kDraws);
  for (double& shift : shifts) {
    const double width = std::sqrt(freedom / chi_squared(generator));
    shift = first.needed(width, generator);
    if (twice) shift = std::max(shift, second.needed(width, generator));
  }
  std::ranges::nth_element(shifts, shifts.begin() + kFound - 1);
  return std::exp(shifts[kFound - 1]);
}

}  // namespace slipstick::bench
