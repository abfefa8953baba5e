#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

/// Files of any program that uses Google Benchmark (--benchmark_format=json).
namespace slipstick::bench {

/// Finite and above zero.
bool is_valid_time(double seconds);

/// One repetition: seconds of one iteration, by the clock and of the processor.
struct Timing {
  double real = 0.0;
  double cpu = 0.0;
};

/// One benchmark of a file: its repetitions in their order; none in files of aggregates only.
struct TimedBenchmark {
  std::string name;  ///< run_name: with its arguments, without the aggregate; the second of a name has " #2"
  int threads = 1;   ///< that Google Benchmark ran it in
  std::vector<Timing> timings;
  std::map<std::string, double> counters;  ///< of the last repetition; only finite values
  std::string error;                       ///< why it failed, or which time is none; empty: it did not
  std::string skipped;                     ///< why it left itself out, which is no failure; empty: it did not
};

/// Where, when and how a file's benchmarks were run.
struct TimingContext {
  std::string host_name;
  int cpus = 0;
  double mhz = 0.0;
  std::string caches;              ///< as JSON
  double load_average = 0.0;       ///< over the minute before the program began; 0: not said
  std::string library_build_type;  ///< of Google Benchmark itself; Debian's says debug always
  std::string build_type;          ///< of the benchmarks: custom context "build_type"; empty: not said
  std::string session;             ///< custom context "session": files that have the same one were run in
                                   ///< interleaved pairs on one machine; empty: not said
};

struct Timings {
  std::filesystem::path file;
  TimingContext context;
  std::vector<TimedBenchmark> benchmarks;  ///< in the order of the file
};

/// Whether both files are of one session.
bool are_paired(const Timings& one, const Timings& other);

/// The benchmark of a name; null where there is none.
const TimedBenchmark* find(const Timings& timings, const std::string& name);

/// Whether a benchmark has times that can be judged: repetitions, each of a valid time.
bool has_times(const TimedBenchmark& benchmark);

/// Reads what versions 1.5 to 1.9 write; a row without a type is a repetition. Throws InputError with file
/// and key for another file or one without benchmarks.
Timings read_timings(const std::filesystem::path& file);

/// The JSON that a program of Google Benchmark wrote, infinities and NaN as null. Throws InputError with the
/// source for any other text.
nlohmann::ordered_json parse_benchmark_json(const std::string& text, const std::string& source);

/// The same of a text; messages call it `source`.
Timings parse_timings(const std::string& text, const std::string& source);

}  // namespace slipstick::bench
