#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

/// Benchmarks run in turn, so that what else the machine does falls on all of them.
namespace slipstick::bench {

/// How long one run of a benchmark lasts.
struct RunLength {
  double seconds = 0.05;  ///< at least, of what is timed
  int repetitions = 1;
};

/// The benchmarks of a program of Google Benchmark whose names fit a regular expression (POSIX extended;
/// empty: those that it runs by itself), in its order. Throws InputError where that is no such program, or
/// has none.
std::vector<std::string> list_benchmarks(const std::filesystem::path& program, const std::string& filter);

/// Runs one benchmark in a process of its own; what it says, in Google Benchmark's JSON. Throws
/// std::runtime_error where it ends otherwise.
nlohmann::ordered_json run_benchmark(const std::filesystem::path& program, const std::string& name,
                                     const RunLength& length);

/// A benchmark of a program, and the name under which it is compared.
struct Contestant {
  std::filesystem::path program;
  std::string benchmark;
  std::string name;
};
/// Contestants that are run one right after the other. Each stands for one of the files that come of it; one
/// whose benchmark is empty is not run.
using Heat = std::vector<Contestant>;

/// Called after each heat.
using RoundProgress = std::function<void(const Heat& heat)>;

/// Says whether the machine works as quickly as it can just now.
using AtFullPace = std::function<bool()>;

/// What came of a heat, a run for each place; null where nothing is run.
struct RunHeat {
  std::vector<nlohmann::ordered_json> runs;
  bool steady = true;  ///< the machine was at its full pace before and after
};

/// That a sitting waits in all for the machine's full pace, what is run in vain among it. Slow spells of a
/// shared machine last seconds to minutes.
using Patience = std::chrono::duration<double>;
inline constexpr Patience kPatience{120.0};

/// Waits until the machine is at its full pace, or until there is no patience left.
void wait_for_full_pace(const AtFullPace& at_full_pace, Patience& left);

/// Runs a heat, its places in their order or in the reverse one; again where the machine was not at its full
/// pace before or after, as long as there is patience.
RunHeat run_heat(const Heat& heat, bool reverse, const RunLength& length, const AtFullPace& at_full_pace,
                 Patience& left);

/// What a sitting has brought.
struct Sitting {
  /// One for each place in a heat, in Google Benchmark's JSON, a repetition a round; all with the same
  /// "sitting" in their context.
  std::vector<nlohmann::ordered_json> files;
  std::size_t heats = 0;
  std::size_t unsteady = 0;  ///< heats that were kept though the machine was not at its full pace
};

/// Runs all heats, `rounds` times, every other time in the reverse order: AB, BA, AB... A heat before or
/// after which the machine is not at its full pace is run again, for two minutes in all.
Sitting run_in_turn(const std::vector<Heat>& heats, int rounds, const RunLength& length,
                    const RoundProgress& progress, const AtFullPace& at_full_pace = {});

}  // namespace slipstick::bench
