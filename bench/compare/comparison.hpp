#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bench/timing/timings.hpp"

namespace slipstick::bench {

/// The rules by which a benchmark is called slower or quicker.
struct ComparisonRules {
  double effect = 0.10;       ///< smallest change of the time that counts
  double level = 0.01;        ///< of significance, over all benchmarks of a comparison together (Holm 1979)
  bool same_machine = false;  ///< the caller vouches for that
  bool debug_library =
      false;  ///< Google Benchmark may say that it was built without NDEBUG, as Debian's does
};

/// The verdict on one benchmark. Undecided: slower by more than the threshold, but not significantly. Too
/// few: this number of repetitions cannot prove any change. Failed: in the new file only. Not timed: it
/// failed in the base, skipped itself, or has no repetitions. Not judged: an obstacle forbids it.
enum class Finding {
  same,
  slower,
  quicker,
  undecided,
  too_few,
  only_in_base,
  only_in_new,
  failed,
  not_timed,
  not_judged
};
std::string to_string(Finding finding);
bool is_failure(Finding finding);  ///< slower or failed
bool is_fine(Finding finding);     ///< same or quicker

/// One benchmark of either file. Missing numbers, and the interval of too small a sample, are NaN.
struct ComparedBenchmark {
  std::string name;
  Finding finding = Finding::not_judged;
  double base_seconds = 0.0;  ///< medians, by the clock
  double new_seconds = 0.0;
  double ratio = 0.0;  ///< new over base: Hodges and Lehmann's estimate (1963) on logarithms
  double low = 0.0;    ///< its 95 % interval
  double high = 0.0;
  double p_value =
      0.0;  ///< of a ratio of one or below (above, where it is below one), with Holm's correction
  std::size_t base_repetitions = 0;
  std::size_t new_repetitions = 0;
  std::string remark;  ///< a remark on the numbers; may be empty
};

struct Comparison {
  std::vector<ComparedBenchmark> benchmarks;  ///< in the base's order, then those only in the new file
  std::vector<std::string> obstacles;  ///< why times could not be judged: the machines, the build, the load
  bool paired = false;                 ///< repetition by repetition
};

/// The two files of a comparison.
struct TwoTimings {
  Timings base;
  Timings now;
};

/// Two files of one session are compared repetition by repetition (Wilcoxon's signed ranks on the logarithms
/// of ratios), others as independent samples (Mann and Whitney's test), both exactly.
/// Throws std::invalid_argument for an effect that is not above zero and a level that is not between 0 and 1.
Comparison compare(const TwoTimings& files, const ComparisonRules& rules = {});

/// Benchmarks that are to run a second time before anything is said: slower, undecided or failed.
std::vector<std::string> suspicious(const Comparison& comparison);

/// A comparison after its suspicious benchmarks ran again. A benchmark is slower if both runs find it as much
/// slower as counts and the second one significantly so, failed if it failed in both, undecided if the second
/// run could neither prove nor clear it. The numbers are the first run's, the chance is the second's.
Comparison confirm(const Comparison& first, const Comparison& second);

/// 1: a benchmark is slower or failed in the new file only. 2: else, where something could not be judged, or
/// nothing was.
int exit_code(const Comparison& comparison);

}  // namespace slipstick::bench
