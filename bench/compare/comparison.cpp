#include "bench/compare/comparison.hpp"

#include <fmt/core.h>
#include <gsl/gsl_statistics_double.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "bench/compare/obstacles.hpp"
#include "bench/compare/rank_tests.hpp"

namespace slipstick::bench {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

using Benchmarks = std::vector<ComparedBenchmark>;

std::vector<double> log_times(const TimedBenchmark& benchmark) {
  std::vector<double> logs;
  for (const Timing& timing : benchmark.timings) logs.push_back(std::log(timing.real));
  return logs;
}

double median_seconds(const TimedBenchmark* benchmark) {
  if (benchmark == nullptr || !has_times(*benchmark)) return kNaN;
  std::vector<double> seconds;
  for (const Timing& timing : benchmark->timings) seconds.push_back(timing.real);
  return gsl_stats_median(seconds.data(), 1, seconds.size());
}

/// The shift of the logarithms of times, which is the logarithm of their ratio.
Shift log_ratio(const TimedBenchmark& base, const TimedBenchmark& now, bool paired) {
  std::vector<double> before = log_times(base);
  const std::vector<double> after = log_times(now);
  if (!paired) return rank_sum_shift(before, after);
  const std::size_t pairs = std::min(before.size(), after.size());
  before.resize(pairs);
  for (std::size_t i = 0; i < pairs; ++i) before[i] = after[i] - before[i];
  return signed_rank_shift(before);
}

double least_chance(std::size_t base, std::size_t now, bool paired) {
  return paired ? least_signed_rank_chance(std::min(base, now)) : least_rank_sum_chance(base, now);
}

/// Repetitions in each file from which on a change can be significant.
std::size_t enough_repetitions(std::size_t comparisons, double level, bool paired) {
  std::size_t repetitions = 2;
  while (!(least_chance(repetitions, repetitions, paired) * static_cast<double>(comparisons) <= level)) {
    ++repetitions;
  }
  return repetitions;
}

/// Why a benchmark has no times to compare; empty: it has.
std::string trouble(const TimedBenchmark& benchmark) {
  if (!benchmark.error.empty()) return benchmark.error;
  if (!benchmark.skipped.empty()) return "skipped: " + benchmark.skipped;
  if (benchmark.timings.empty()) return "aggregates only, no repetitions";
  return has_times(benchmark) ? "" : "a time is no number above zero";
}

/// A benchmark before times are compared, not judged where there are some; null: the file does not hold it.
ComparedBenchmark match(const TimedBenchmark* base, const TimedBenchmark* now) {
  ComparedBenchmark matched;
  matched.name = base == nullptr ? now->name : base->name;
  matched.base_seconds = median_seconds(base);
  matched.new_seconds = median_seconds(now);
  matched.base_repetitions = base == nullptr ? 0 : base->timings.size();
  matched.new_repetitions = now == nullptr ? 0 : now->timings.size();
  matched.ratio = matched.low = matched.high = matched.p_value = kNaN;
  if (base == nullptr || now == nullptr) {
    matched.finding = now == nullptr ? Finding::only_in_base : Finding::only_in_new;
  } else if (const std::string before = trouble(*base); !before.empty()) {
    matched.finding = Finding::not_timed;
    matched.remark = "in the base: " + before;
  } else if (const std::string after = trouble(*now); !after.empty()) {
    const bool failed = !now->error.empty() || !now->timings.empty();
    matched.finding = failed ? Finding::failed : Finding::not_timed;
    matched.remark = after;
  }
  return matched;
}

struct Pair {
  std::size_t place;  ///< among the compared benchmarks
  Shift shift;
};

/// A benchmark's verdict by its numbers, which are all set.
Finding judge(const ComparedBenchmark& benchmark, bool could_show, const ComparisonRules& rules) {
  const bool significant = benchmark.p_value <= rules.level;
  if (significant && benchmark.ratio >= 1.0 + rules.effect) return Finding::slower;
  if (significant && benchmark.ratio <= 1.0 / (1.0 + rules.effect)) return Finding::quicker;
  if (!could_show) return Finding::too_few;
  return benchmark.ratio < 1.0 + rules.effect ? Finding::same : Finding::undecided;
}

/// A remark on numbers that could be misread.
std::string remark_on(const ComparedBenchmark& benchmark, std::size_t enough, const ComparisonRules& rules) {
  if (benchmark.finding == Finding::too_few) {
    return fmt::format("no change can be significant; {} repetitions in each file would do", enough);
  }
  if (benchmark.finding == Finding::same && benchmark.low > 1.0) return "slower, below what counts";
  if (benchmark.finding == Finding::same && !(benchmark.high < 1.0 + rules.effect)) {
    return fmt::format("scatters too much to rule {:.0f} % out", 100.0 * rules.effect);
  }
  return "";
}

void judge_all(Benchmarks& benchmarks, const std::vector<Pair>& pairs, bool paired,
               const ComparisonRules& rules) {
  std::vector<double> positive;
  std::vector<double> negative;
  for (const Pair& pair : pairs) {
    positive.push_back(pair.shift.p_positive);
    negative.push_back(pair.shift.p_negative);
  }
  positive = holm(positive);
  negative = holm(negative);
  const std::size_t enough = enough_repetitions(pairs.size(), rules.level, paired);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    ComparedBenchmark& benchmark = benchmarks[pairs[i].place];
    const Shift& shift = pairs[i].shift;
    benchmark.ratio = std::exp(shift.estimate);
    benchmark.low = std::exp(shift.low);
    benchmark.high = std::exp(shift.high);
    benchmark.p_value = shift.estimate < 0.0 ? negative[i] : positive[i];
    const double least = least_chance(benchmark.base_repetitions, benchmark.new_repetitions, paired);
    const bool could_show = least * static_cast<double>(pairs.size()) <= rules.level;
    benchmark.finding = judge(benchmark, could_show, rules);
    benchmark.remark = remark_on(benchmark, enough, rules);
  }
}

/// Where times cannot be judged, the numbers stay and the verdicts go.
void clear_verdicts(Benchmarks& benchmarks) {
  for (ComparedBenchmark& benchmark : benchmarks) {
    if (benchmark.finding > Finding::too_few) continue;
    benchmark.finding = Finding::not_judged;
    benchmark.remark.clear();
  }
}

bool needs_second_run(Finding finding) { return is_failure(finding) || finding == Finding::undecided; }

/// A second run is a test of its own, of few benchmarks, so that it alarms by chance no more often than its
/// level says. It may prove a slowdown that the first run found as large as counts, but not significant.
Finding confirmed(Finding first, Finding second) {
  if (first == second || (first == Finding::undecided && second == Finding::slower)) return second;
  return is_fine(second) ? Finding::same : Finding::undecided;
}

std::string numbers(const ComparedBenchmark& benchmark) {
  if (!std::isfinite(benchmark.ratio)) return to_string(benchmark.finding);
  return fmt::format("{} ({:.3f}, p {:.1g})", to_string(benchmark.finding), benchmark.ratio,
                     benchmark.p_value);
}

}  // namespace

std::string to_string(Finding finding) {
  constexpr std::array kNames{"same",         "slower",      "quicker", "undecided", "too few",
                              "only in base", "only in new", "failed",  "not timed", "not judged"};
  return kNames.at(static_cast<std::size_t>(finding));
}

bool is_failure(Finding finding) { return finding == Finding::slower || finding == Finding::failed; }
bool is_fine(Finding finding) { return finding == Finding::same || finding == Finding::quicker; }

Comparison compare(const TwoTimings& files, const ComparisonRules& rules) {
  if (!(rules.effect > 0.0 && rules.level > 0.0 && rules.level < 1.0)) {
    throw std::invalid_argument("an effect is above 0, a level between 0 and 1");
  }
  const auto& [base, now] = files;
  Comparison comparison;
  comparison.paired = are_paired(base, now);
  std::vector<Pair> pairs;
  for (const TimedBenchmark& before : base.benchmarks) {
    const TimedBenchmark* const after = find(now, before.name);
    comparison.benchmarks.push_back(match(&before, after));
    if (comparison.benchmarks.back().finding != Finding::not_judged) continue;
    pairs.push_back({comparison.benchmarks.size() - 1, log_ratio(before, *after, comparison.paired)});
  }
  for (const TimedBenchmark& after : now.benchmarks) {
    if (find(base, after.name) == nullptr) comparison.benchmarks.push_back(match(nullptr, &after));
  }
  judge_all(comparison.benchmarks, pairs, comparison.paired, rules);
  comparison.obstacles = find_obstacles(base, now, rules);
  if (!comparison.obstacles.empty()) clear_verdicts(comparison.benchmarks);
  return comparison;
}

std::vector<std::string> suspicious(const Comparison& comparison) {
  std::vector<std::string> names;
  for (const ComparedBenchmark& benchmark : comparison.benchmarks) {
    if (needs_second_run(benchmark.finding)) names.push_back(benchmark.name);
  }
  return names;
}

Comparison confirm(const Comparison& first, const Comparison& second) {
  Comparison result = first;
  result.obstacles.insert(result.obstacles.end(), second.obstacles.begin(), second.obstacles.end());
  for (ComparedBenchmark& benchmark : result.benchmarks) {
    if (!needs_second_run(benchmark.finding)) continue;
    const auto again = std::ranges::find(second.benchmarks, benchmark.name, &ComparedBenchmark::name);
    const bool ran = again != second.benchmarks.end();
    benchmark.remark =
        fmt::format("{}first run: {}; second: {}", benchmark.remark.empty() ? "" : benchmark.remark + "; ",
                    numbers(benchmark), ran ? numbers(*again) : "it did not run");
    benchmark.finding = ran ? confirmed(benchmark.finding, again->finding) : Finding::undecided;
    if (ran) benchmark.p_value = again->p_value;
  }
  return result;
}

int exit_code(const Comparison& comparison) {
  if (std::ranges::any_of(comparison.benchmarks, is_failure, &ComparedBenchmark::finding)) return 1;
  const bool passed = !comparison.benchmarks.empty() && comparison.obstacles.empty() &&
                      std::ranges::all_of(comparison.benchmarks, is_fine, &ComparedBenchmark::finding);
  return passed ? 0 : 2;
}

}  // namespace slipstick::bench
