#include "bench/compare/comparison.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

#include "bench/compare/obstacles.hpp"
#include "bench/compare/power.hpp"
#include "bench/compare/rank_tests.hpp"
#include "bench/timing/median.hpp"
#include "solver/input/misspelling.hpp"

namespace slipstick::bench {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
/// Edits over letters up to which two names look like one benchmark renamed: fft to dcfft is 0.15.
constexpr double kRenaming = 0.4;

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
  return median(seconds);
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

/// Why two benchmarks of one name have no times to compare, with the finding that follows; not judged: they
/// have.
struct Doubt {
  Finding finding = Finding::not_judged;
  std::string why;
};

Doubt doubt(const TimedBenchmark& base, const TimedBenchmark& now) {
  if (!base.error.empty() && !now.error.empty()) return {Finding::not_timed, "failed in both: " + now.error};
  if (!base.error.empty()) return {Finding::not_timed, "failed in the base: " + base.error};
  if (!now.error.empty()) return {Finding::failed, now.error};
  if (!base.skipped.empty()) return {Finding::not_timed, "skipped in the base: " + base.skipped};
  if (!now.skipped.empty()) return {Finding::not_timed, "skipped in the new file: " + now.skipped};
  if (base.timings.empty()) return {Finding::too_few, "the base holds aggregates only, no repetitions"};
  if (now.timings.empty()) return {Finding::too_few, "the new file holds aggregates only, no repetitions"};
  if (!has_times(base)) return {Finding::not_timed, "a time of the base is no number above zero"};
  if (!has_times(now)) return {Finding::failed, "a time is no number above zero"};
  return {};
}

/// A benchmark of both files, before times are compared; null: the file does not hold it.
ComparedBenchmark match(const std::string& name, const TimedBenchmark* base, const TimedBenchmark* now) {
  ComparedBenchmark matched;
  matched.name = name;
  matched.base_seconds = median_seconds(base);
  matched.new_seconds = median_seconds(now);
  matched.base_repetitions = base == nullptr ? 0 : base->timings.size();
  matched.new_repetitions = now == nullptr ? 0 : now->timings.size();
  matched.ratio = matched.low = matched.high = matched.p_value = matched.smallest_found = kNaN;
  if (base == nullptr || now == nullptr) {
    matched.finding = now == nullptr ? Finding::only_in_base : Finding::only_in_new;
  } else {
    const Doubt found = doubt(*base, *now);
    matched.finding = found.finding;
    matched.remark = found.why;
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

/// A remark where the numbers alone could be misread.
std::string remark_on(const ComparedBenchmark& benchmark, std::size_t enough, bool paired,
                      const ComparisonRules& rules) {
  if (benchmark.finding == Finding::too_few) {
    return fmt::format("no change can be significant; {} repetitions in each file would do", enough);
  }
  if (paired && benchmark.base_repetitions != benchmark.new_repetitions) {
    return fmt::format("only the first {} repetitions are pairs",
                       std::min(benchmark.base_repetitions, benchmark.new_repetitions));
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
    benchmark.remark = remark_on(benchmark, enough, paired, rules);
  }
}

/// Names that are in one file only, and look alike to each other more than to any other such name.
void suggest_renaming(Benchmarks& benchmarks) {
  std::map<Finding, std::vector<std::string>> alone;
  for (const ComparedBenchmark& benchmark : benchmarks) alone[benchmark.finding].push_back(benchmark.name);
  const std::vector<std::string>& before = alone[Finding::only_in_base];
  const std::vector<std::string>& after = alone[Finding::only_in_new];
  for (ComparedBenchmark& benchmark : benchmarks) {
    const bool old = benchmark.finding == Finding::only_in_base;
    if (!old && benchmark.finding != Finding::only_in_new) continue;
    const std::string other = solver::nearest_word(benchmark.name, old ? after : before);
    const auto letters = static_cast<double>(std::max(benchmark.name.size(), other.size()));
    const auto edits = static_cast<double>(solver::edit_distance(benchmark.name, other));
    if (other.empty() || edits > kRenaming * letters ||
        solver::nearest_word(other, old ? before : after) != benchmark.name) {
      continue;
    }
    benchmark.remark = fmt::format("renamed {} {}?", old ? "to" : "from", other);
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
    comparison.benchmarks.push_back(match(before.name, &before, after));
    if (comparison.benchmarks.back().finding != Finding::not_judged) continue;
    pairs.push_back({comparison.benchmarks.size() - 1, log_ratio(before, *after, comparison.paired)});
  }
  for (const TimedBenchmark& after : now.benchmarks) {
    if (find(base, after.name) == nullptr)
      comparison.benchmarks.push_back(match(after.name, nullptr, &after));
  }
  judge_all(comparison.benchmarks, pairs, comparison.paired, rules);
  suggest_renaming(comparison.benchmarks);
  comparison.waiting = waiting_benchmarks(now);
  Obstacles found = find_obstacles(base, now, rules);
  comparison.obstacles = std::move(found.obstacles);
  comparison.remarks = std::move(found.remarks);
  if (!comparison.obstacles.empty()) clear_verdicts(comparison.benchmarks);
  return comparison;
}

void state_power(Comparison& comparison, const TwoTimings& files, const ComparisonRules& rules) {
  const auto is_timed = [](const ComparedBenchmark& benchmark) { return std::isfinite(benchmark.ratio); };
  const auto timed = static_cast<double>(std::ranges::count_if(comparison.benchmarks, is_timed));
  const Search search{.effect = rules.effect,
                      .level = rules.second_run > 0 ? rules.level : rules.level / timed,
                      .second_run = rules.second_run};
  for (ComparedBenchmark& benchmark : comparison.benchmarks) {
    if (!is_timed(benchmark)) continue;
    benchmark.smallest_found =
        smallest_found(log_times(*find(files.base, benchmark.name)),
                       log_times(*find(files.now, benchmark.name)), comparison.paired, search);
  }
}

std::vector<std::string> suspicious(const Comparison& comparison) {
  std::vector<std::string> names;
  for (const ComparedBenchmark& benchmark : comparison.benchmarks) {
    if (needs_second_run(benchmark.finding)) names.push_back(benchmark.name);
  }
  return names;
}

TwoTimings select(const TwoTimings& files, const std::vector<std::string>& names) {
  TwoTimings selected = files;
  for (Timings* const file : {&selected.base, &selected.now}) {
    std::erase_if(file->benchmarks, [&](const TimedBenchmark& benchmark) {
      return std::ranges::find(names, benchmark.name) == names.end();
    });
  }
  return selected;
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
