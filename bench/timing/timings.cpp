#include "bench/timing/timings.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
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
  /// NaN for null.
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

TimingContext read_context(const Reader& context) {
  TimingContext read;
  read.host_name = context.text("host_name");
  read.cpus = context.whole("num_cpus", 0);
  read.mhz = context.has("mhz_per_cpu") ? context.number("mhz_per_cpu") : 0.0;
  read.caches = context.json().value("caches", Json::array()).dump();
  read.library_build_type = context.text("library_build_type");
  read.build_type = context.text("build_type");
  read.session = context.text("session");
  const Json load = context.json().value("load_avg", Json::array());
  if (!load.is_array() || (!load.empty() && !load.front().is_number())) {
    context.refuse("load_avg", "a list of numbers");
  }
  if (!load.empty()) read.load_average = load.front().get<double>();
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

/// Rows of complexity fits are of a family, not of a benchmark.
bool is_fit(const Reader& row) {
  const std::string aggregate = row.text("aggregate_name");
  return aggregate == "BigO" || aggregate == "RMS";
}

/// Puts rows together to benchmarks, in their order.
std::vector<TimedBenchmark> read_benchmarks(const Json& rows, const std::string& source) {
  std::vector<TimedBenchmark> benchmarks;
  std::map<std::tuple<std::string, int, int>, std::size_t> places;  // two of one name are of two families
  std::map<std::string, int> number;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Reader row(rows[i], source, fmt::format("benchmarks[{}]", i));
    if (!rows[i].is_object()) throw InputError(source, fmt::format("benchmarks[{}] is no object", i));
    if (is_fit(row)) continue;
    const std::string name = row.text(row.has("run_name") ? "run_name" : "name");
    if (name.empty()) row.refuse("name", "the name of a benchmark");
    const auto [place, is_new] = places.try_emplace(
        {name, row.whole("family_index", 0), row.whole("per_family_instance_index", 0)}, benchmarks.size());
    if (is_new) {
      const int same = ++number[name];
      benchmarks.emplace_back().name = same == 1 ? name : fmt::format("{} #{}", name, same);
    }
    if (row.text("run_type") != "aggregate") add_repetition(benchmarks[place->second], row);
  }
  return benchmarks;
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
