#include "bench/compare/obstacles.hpp"

#include <fmt/ranges.h>
#include <gsl/gsl_statistics_double.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace slipstick::bench {
namespace {

/// A clock that is measured, not read, comes out a few percent different each time.
constexpr double kClockTolerance = 0.05;
/// The part of the processors that other programs may keep busy when a run begins. A run in one thread finds
/// a free processor then; it still shares caches, memory and the heat that limits the clock.
constexpr double kForeignLoad = 0.5;
/// Time by the clock over the processor's: a quiet machine stays within a few percent of 1, three programs on
/// two processors make it 1.5.
constexpr double kWaiting = 1.25;
/// A benchmark that waits for nine tenths of its time does so by its nature: a machine that is as busy as
/// that shows in its load average.
constexpr double kWaitingByNature = 10.0;
/// A wait that a change put into the program is in some benchmarks, one for a loaded machine is in most.
/// Fewer benchmarks than this decide nothing.
constexpr std::ptrdiff_t kMinConclusive = 3;

std::string name(const Timings& timings) { return timings.file.filename().string(); }

std::vector<std::string> machine_differences(const TimingContext& base, const TimingContext& now) {
  std::vector<std::string> differences;
  const auto differ = [&](const char* what, const auto& one, const auto& other) {
    if (one != other) differences.push_back(fmt::format("{} {} and {}", what, one, other));
  };
  differ("host_name", base.host_name, now.host_name);
  differ("num_cpus", base.cpus, now.cpus);
  if (!(std::abs(now.mhz - base.mhz) <= kClockTolerance * base.mhz)) {
    differ("mhz_per_cpu", base.mhz, now.mhz);
  }
  differ("caches", base.caches, now.caches);
  return differences;
}

std::string debug_build(const Timings& timings, const ComparisonRules& rules) {
  std::string type = timings.context.build_type;
  std::transform(type.begin(), type.end(), type.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (type == "debug") return fmt::format("{}: a debug build (build_type)", name(timings));
  if (!type.empty() || rules.debug_library || timings.context.library_build_type != "debug") return "";
  return fmt::format(
      "{}: a debug build, by library_build_type (if only Google Benchmark's library is one, as Debian's says "
      "of itself: --debug-library, or a custom context build_type=release)",
      name(timings));
}

std::string load(const Timings& timings) {
  const TimingContext& context = timings.context;
  if (context.cpus == 0) return "";
  int own = 1;  // what the run itself uses, and one just before it
  for (const TimedBenchmark& benchmark : timings.benchmarks) own = std::max(own, benchmark.threads);
  const double foreign = context.load_average - own;
  if (foreign <= kForeignLoad * context.cpus) return "";
  return fmt::format(
      "{}: the machine was loaded when it began (load average {:.2f} on {} processors; the program explains "
      "{}); run it again when the others are done",
      name(timings), context.load_average, context.cpus, own);
}

/// The median of clock over processor time; 1 where the processor time includes other work.
double waiting_factor(const TimedBenchmark& benchmark) {
  const bool brings_own_time = benchmark.name.find("/manual_time") != std::string::npos ||
                               benchmark.name.find("/process_time") != std::string::npos;
  if (!has_times(benchmark) || benchmark.threads != 1 || brings_own_time) return 1.0;
  std::vector<double> ratios;
  for (const Timing& timing : benchmark.timings) {
    ratios.push_back(timing.cpu > 0.0 ? timing.real / timing.cpu : 1.0);
  }
  return gsl_stats_median(ratios.data(), 1, ratios.size());
}

/// Whether most benchmarks wait.
std::string waiting(const Timings& timings) {
  const auto all = std::ssize(timings.benchmarks);
  const auto waiting = std::ranges::count_if(timings.benchmarks, [](const TimedBenchmark& benchmark) {
    const double factor = waiting_factor(benchmark);
    return factor >= kWaiting && factor < kWaitingByNature;
  });
  if (all < kMinConclusive || 2 * waiting <= all) return "";
  return fmt::format(
      "{}: the machine was loaded: {} of {} benchmarks took {} times as long as the processor worked for "
      "them, "
      "or longer (if that is their nature: MeasureProcessCPUTime or UseManualTime)",
      name(timings), waiting, all, kWaiting);
}

std::vector<double> all_times(const Timings& timings) {
  std::vector<double> all;
  for (const TimedBenchmark& benchmark : timings.benchmarks) {
    for (const Timing& timing : benchmark.timings) all.push_back(timing.real);
  }
  return all;
}

}  // namespace

std::vector<std::string> find_obstacles(const Timings& base, const Timings& now,
                                        const ComparisonRules& rules) {
  std::vector<std::string> found;
  const bool paired = are_paired(base, now);
  const std::vector<std::string> differences = machine_differences(base.context, now.context);
  if (!differences.empty() && !rules.same_machine && !paired) {
    found.push_back(fmt::format("the machines differ: {} (if it is one machine: --same-machine)",
                                fmt::join(differences, "; ")));
  }
  for (const Timings* const timings : {&base, &now}) {
    found.push_back(debug_build(*timings, rules));
    found.push_back(load(*timings));
    if (!paired) found.push_back(waiting(*timings));
  }
  const std::vector<double> times = all_times(base);
  if (!times.empty() && times == all_times(now))
    found.push_back("both files hold the very same times: one run is compared with itself");
  std::erase(found, "");
  return found;
}

}  // namespace slipstick::bench
