#include "bench/compare/obstacles.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "bench/timing/median.hpp"

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
  if (base.caches != now.caches) {
    differences.push_back(
        fmt::format("caches ({}) and ({})", fmt::join(base.caches, ", "), fmt::join(now.caches, ", ")));
  }
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
  if (context.load_average.empty() || context.cpus == 0) return "";
  int own = 1;  // what the run itself uses, and one just before it
  for (const TimedBenchmark& benchmark : timings.benchmarks) own = std::max(own, benchmark.threads);
  const double foreign = context.load_average.front() - own;
  if (foreign <= kForeignLoad * context.cpus) return "";
  return fmt::format(
      "{}: the machine was loaded when it began (load average {:.2f} on {} processors, of which it explains "
      "{}); run it again when the others are done",
      name(timings), context.load_average.front(), context.cpus, own);
}

/// Whether the processor's time is that of the work which the clock times.
bool has_both_times(const TimedBenchmark& benchmark) {
  return has_times(benchmark) && benchmark.threads == 1 &&
         benchmark.name.find("/manual_time") == std::string::npos &&
         benchmark.name.find("/process_time") == std::string::npos &&
         std::ranges::all_of(benchmark.timings, [](const Timing& timing) { return timing.cpu > 0.0; });
}

bool waits(const TimedBenchmark& benchmark) {
  std::vector<double> ratios;
  for (const Timing& timing : benchmark.timings) ratios.push_back(timing.real / timing.cpu);
  const double ratio = median(ratios);
  return ratio >= kWaiting && ratio < kWaitingByNature;
}

/// Whether most benchmarks wait, but for those that are known to.
std::string waiting(const Timings& timings, const std::vector<std::string>& known) {
  const auto waiting = std::ranges::count_if(waiting_benchmarks(timings), [&](const std::string& benchmark) {
    return std::ranges::find(known, benchmark) == known.end();
  });
  const auto all = std::ranges::count_if(timings.benchmarks, has_both_times);
  if (all < kMinConclusive || 2 * waiting <= all) return "";
  return fmt::format(
      "{}: the machine was loaded: {} of {} benchmarks in one thread took {} times as long as the processor "
      "worked for them, or longer (if that is their nature: MeasureProcessCPUTime or UseManualTime)",
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

std::vector<std::string> waiting_benchmarks(const Timings& timings) {
  std::vector<std::string> names;
  for (const TimedBenchmark& benchmark : timings.benchmarks) {
    if (has_both_times(benchmark) && waits(benchmark)) names.push_back(benchmark.name);
  }
  return names;
}

Obstacles find_obstacles(const Timings& base, const Timings& now, const ComparisonRules& rules) {
  Obstacles found;
  const auto add = [&](const std::string& obstacle) {
    if (!obstacle.empty()) found.obstacles.push_back(obstacle);
  };
  const std::vector<std::string> differences = machine_differences(base.context, now.context);
  if (!differences.empty() && !rules.same_machine && !are_paired(base, now)) {
    add(fmt::format("the machines differ: {} (if it is one machine: --same-machine)",
                    fmt::join(differences, "; ")));
  }
  for (const Timings* const timings : {&base, &now}) {
    add(debug_build(*timings, rules));
    add(load(*timings));
    if (timings->context.scaling.value_or(false)) {
      found.remarks.push_back(fmt::format(
          "{}: the processor's frequency was free to change, times scatter more", name(*timings)));
    }
  }
  add(waiting(base, {}));
  add(waiting(now, rules.waiting));
  const std::vector<double> times = all_times(base);
  if (!times.empty() && times == all_times(now))
    add("both files hold the very same times: one run is compared with itself");
  return found;
}

}  // namespace slipstick::bench
