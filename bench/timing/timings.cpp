#include "bench/timing/timings.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "convergence/results/json_text.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/input_file.hpp"

namespace slipstick::bench {
namespace {

using Json = nlohmann::ordered_json;
using solver::InputError;

constexpr const char* kAllowed = "what a Google Benchmark program writes with --benchmark_format=json";

/// Google Benchmark writes numbers that are not finite as they are, which JSON cannot hold: null instead.
std::string without_bare_nans(const std::string& text) {
  const auto is_letter = [&](std::size_t at) {
    return at < text.size() && std::isalpha(static_cast<unsigned char>(text[at])) != 0;
  };
  std::string json;
  bool in_string = false;
  for (std::size_t i = 0, length = 1; i < text.size(); i += length) {
    length = in_string && text[i] == '\\' ? 2 : 1;
    if (text[i] == '"') in_string = !in_string;
    if (!in_string && (is_letter(i) || (text[i] == '-' && is_letter(i + 1)))) {
      while (is_letter(i + length)) ++length;
      const std::string word = text.substr(i, length);
      json += word == "true" || word == "false" || word == "e" || word == "E" ? word : "null";
    } else {
      json += text.substr(i, length);
    }
  }
  return json;
}

/// The values of one object of a file, which stands at `place`.
class Reader {
 public:
  Reader(const Json& object, std::string source, std::string place)
      : object_(object), source_(std::move(source)), place_(std::move(place)) {}

  bool has(const std::string& key) const { return object_.contains(key); }

  std::string text(const std::string& key) const {
    return value(key, std::string(), &Json::is_string, "a string");
  }
  bool flag(const std::string& key) const { return value(key, false, &Json::is_boolean, "true or false"); }
  int whole(const std::string& key, int otherwise) const {
    return value(key, otherwise, &Json::is_number_integer, "a whole number");
  }
  /// NaN for what is null.
  double number(const std::string& key) const {
    if (has(key) && object_.at(key).is_null()) return std::numeric_limits<double>::quiet_NaN();
    return value(key, std::numeric_limits<double>::quiet_NaN(), &Json::is_number, "a number");
  }
  [[noreturn]] void refuse(const std::string& key, const std::string& allowed) const {
    throw InputError(source_, place_ + "." + key, has(key) ? object_.at(key).dump() : "nothing", allowed);
  }
  const Json& json() const { return object_; }

 private:
  template <typename Value>
  Value value(const std::string& key, Value otherwise, bool (Json::*is_right)() const noexcept,
              const char* allowed) const {
    if (!has(key)) return otherwise;
    if (!(object_.at(key).*is_right)()) refuse(key, allowed);
    return object_.at(key).get<Value>();
  }

  const Json& object_;
  std::string source_;
  std::string place_;
};

std::string cache_text(const Json& cache) {
  const auto part = [&](const char* key) {
    const Json value = cache.value(key, Json());
    return value.is_string() ? value.get<std::string>() : value.dump();
  };
  return fmt::format("L{} {} {} shared by {}", part("level"), part("type"), part("size"),
                     part("num_sharing"));
}

TimingContext read_context(const Reader& context) {
  TimingContext read;
  read.host_name = context.text("host_name");
  read.cpus = context.whole("num_cpus", 0);
  read.mhz = context.has("mhz_per_cpu") ? context.number("mhz_per_cpu") : 0.0;
  if (context.has("cpu_scaling_enabled")) read.scaling = context.flag("cpu_scaling_enabled");
  read.library_build_type = context.text("library_build_type");
  read.build_type = context.text("build_type");
  read.session = context.text("session");
  const auto list = [&](const char* key, const char* allowed) {
    Json values = context.json().value(key, Json::array());
    if (!values.is_array()) context.refuse(key, allowed);
    return values;
  };
  const char* const caches = "a list of objects with level, type, size, num_sharing";
  for (const Json& cache : list("caches", caches)) {
    if (!cache.is_object()) context.refuse("caches", caches);
    read.caches.push_back(cache_text(cache));
  }
  for (const Json& load : list("load_avg", "a list of numbers")) {
    if (!load.is_number()) context.refuse("load_avg", "a list of numbers");
    read.load_average.push_back(load.get<double>());
  }
  return read;
}

double seconds_per(const Reader& row) {
  const std::string unit = row.has("time_unit") ? row.text("time_unit") : "ns";
  constexpr std::array<std::pair<std::string_view, double>, 4> units{
      {{"ns", 1e-9}, {"us", 1e-6}, {"ms", 1e-3}, {"s", 1.0}}};
  for (const auto& [name, seconds] : units) {
    if (unit == name) return seconds;
  }
  row.refuse("time_unit", "ns, us, ms, s");
}

/// Rows of a file, so that those which do not say what they are can be distinguished.
using Names = std::set<std::string>;

/// Whether a row without run_type is an aggregate: it is named after another row, or there are a mean and a
/// deviation of one name.
bool is_old_aggregate(const Reader& row, const Names& names) {
  const std::string name = row.text("name");
  for (const char* ending : {"_mean", "_median", "_stddev", "_cv", "_BigO", "_RMS"}) {
    if (!name.ends_with(ending)) continue;
    const std::string stem = name.substr(0, name.rfind('_'));
    return names.contains(stem) || (names.contains(stem + "_mean") && names.contains(stem + "_stddev"));
  }
  return false;
}

struct Row {
  std::string name;
  int family = 0;  ///< two benchmarks of one name are of two families
  int instance = 0;
  bool aggregate = false;
};

Row identify(const Reader& row, const Names& names) {
  Row read;
  if (row.text("name").empty()) row.refuse("name", "the name of a benchmark");
  const std::string type = row.text("run_type");
  if (!type.empty() && type != "iteration" && type != "aggregate")
    row.refuse("run_type", "iteration, aggregate");
  read.aggregate = type.empty() ? is_old_aggregate(row, names) : type == "aggregate";
  read.name = row.text("run_name");
  if (read.name.empty()) {
    read.name = row.text("name");
    if (read.aggregate) read.name = read.name.substr(0, read.name.rfind('_'));
  }
  read.family = row.whole("family_index", 0);
  read.instance = row.whole("per_family_instance_index", 0);
  return read;
}

std::map<std::string, double> read_counters(const Reader& row) {
  static const std::set<std::string> known{"family_index", "per_family_instance_index",
                                           "repetitions",  "repetition_index",
                                           "threads",      "iterations",
                                           "real_time",    "cpu_time"};
  std::map<std::string, double> counters;
  for (const auto& [key, value] : row.json().items()) {
    if (value.is_number() && !known.contains(key)) counters[key] = value.get<double>();
  }
  return counters;
}

void add_repetition(TimedBenchmark& benchmark, const Reader& row) {
  if (row.flag("error_occurred")) {
    const std::string message = row.text("error_message");
    benchmark.error = message.empty() ? "it says that an error occurred" : message;
    return;
  }
  if (row.flag("skipped")) {
    const std::string message = row.text("skip_message");
    benchmark.skipped = message.empty() ? "it says that it was skipped" : message;
    return;
  }
  const double seconds = seconds_per(row);
  if (!row.has("real_time")) row.refuse("real_time", "a number");
  benchmark.timings.push_back(
      {.real = seconds * row.number("real_time"), .cpu = seconds * row.number("cpu_time")});
  benchmark.counters = read_counters(row);
  benchmark.threads = row.whole("threads", 1);
  const double real = benchmark.timings.back().real;
  if (!is_valid_time(real) && benchmark.error.empty()) {
    benchmark.error =
        fmt::format("the time of repetition {} is {}, which is none", benchmark.timings.size(), real);
  }
}

/// Puts rows together to benchmarks, in their order.
class Gathering {
 public:
  TimedBenchmark& benchmark(const Row& row) {
    const auto found = places_.find({row.name, row.family, row.instance});
    if (found != places_.end()) return benchmarks_[found->second];
    places_[{row.name, row.family, row.instance}] = benchmarks_.size();
    const int same = ++number_[row.name];
    TimedBenchmark benchmark;
    benchmark.name = same == 1 ? row.name : fmt::format("{} #{}", row.name, same);
    benchmarks_.push_back(std::move(benchmark));
    return benchmarks_.back();
  }
  std::vector<TimedBenchmark> take() && { return std::move(benchmarks_); }

 private:
  std::vector<TimedBenchmark> benchmarks_;
  std::map<std::tuple<std::string, int, int>, std::size_t> places_;
  std::map<std::string, int> number_;
};

/// Rows of complexity fits are of a family, not of a benchmark.
bool is_fit(const Reader& row) {
  const std::string aggregate = row.text("aggregate_name");
  return aggregate == "BigO" || aggregate == "RMS" || row.has("rms") || row.has("real_coefficient");
}

std::vector<TimedBenchmark> read_benchmarks(const Json& rows, const std::string& source) {
  Names names;
  for (const Json& row : rows) {
    if (row.is_object() && row.contains("name") && row["name"].is_string()) names.insert(row["name"]);
  }
  Gathering gathering;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Reader row(rows[i], source, fmt::format("benchmarks[{}]", i));
    if (!rows[i].is_object()) throw InputError(source, fmt::format("benchmarks[{}] is no object", i));
    if (is_fit(row)) continue;
    const Row identity = identify(row, names);
    TimedBenchmark& benchmark = gathering.benchmark(identity);
    if (!identity.aggregate) add_repetition(benchmark, row);
  }
  return std::move(gathering).take();
}

}  // namespace

bool is_valid_time(double seconds) { return seconds > 0.0 && std::isfinite(seconds); }

bool are_paired(const Timings& one, const Timings& other) {
  return !one.context.session.empty() && one.context.session == other.context.session;
}

const TimedBenchmark* find(const Timings& timings, const std::string& name) {
  const auto found = std::ranges::find(timings.benchmarks, name, &TimedBenchmark::name);
  return found == timings.benchmarks.end() ? nullptr : &*found;
}

bool has_times(const TimedBenchmark& benchmark) {
  return !benchmark.timings.empty() && std::ranges::all_of(benchmark.timings, is_valid_time, &Timing::real);
}

Json parse_benchmark_json(const std::string& text, const std::string& source) {
  Json json = convergence::parse_json(without_bare_nans(text), source, kAllowed);
  const auto is = [&](const char* key, Json::value_t type) {
    return json.is_object() && json.contains(key) && json[key].type() == type;
  };
  if (!is("context", Json::value_t::object) || !is("benchmarks", Json::value_t::array)) {
    throw InputError(source, fmt::format("has no context and benchmarks; allowed: {}", kAllowed));
  }
  return json;
}

Timings parse_timings(const std::string& text, const std::string& source) {
  const Json json = parse_benchmark_json(text, source);
  Timings timings{.file = source,
                  .context = read_context(Reader(json["context"], source, "context")),
                  .benchmarks = read_benchmarks(json["benchmarks"], source)};
  if (timings.benchmarks.empty()) throw InputError(source, "holds no benchmark");
  return timings;
}

Timings read_timings(const std::filesystem::path& file) {
  return parse_timings(solver::read_input_file(file, solver::kLargestJson, kAllowed), file.string());
}

}  // namespace slipstick::bench
