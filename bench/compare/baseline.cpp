#include "bench/compare/baseline.hpp"

#include <fmt/core.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <string_view>
#include <vector>

#include "bench/timing/median.hpp"
#include "convergence/results/whole_file.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::bench {
namespace {

using Json = nlohmann::ordered_json;

/// What of a file's context decides whether times can be compared.
constexpr const char* kContext[] = {"date",     "num_cpus",           "mhz_per_cpu", "cpu_scaling_enabled",
                                    "caches",   "library_build_type", "build_type",  "machine",
                                    "load_avg", "pace_seconds"};

/// To four digits: a time is never known better.
double rounded(double value) { return std::strtod(fmt::format("{:.4g}", value).c_str(), nullptr); }

double unit(const Json& row) {
  const auto name = row.value("time_unit", "ns");
  return name == "s" ? 1.0 : name == "ms" ? 1e-3 : name == "us" ? 1e-6 : 1e-9;
}

Json medians(const Json& rows) {
  std::map<std::string, std::vector<double>> seconds;
  for (const Json& row : rows) {
    seconds[row.at("run_name")].push_back(unit(row) * row.at("real_time").get<double>());
  }
  Json result = Json::object();
  for (const auto& [name, values] : seconds) result[name] = rounded(median(values));
  return result;
}

Json kept_row(const Json& row) {
  Json kept{{"name", row.at("run_name")}, {"run_name", row.at("run_name")}, {"run_type", "iteration"}};
  for (const char* key : {"repetitions", "repetition_index", "threads"}) {
    if (row.contains(key)) kept[key] = row[key];
  }
  for (const char* key : {"real_time", "cpu_time"}) kept[key] = rounded(row.at(key).get<double>());
  kept["time_unit"] = row.value("time_unit", "ns");
  return kept;
}

}  // namespace

std::filesystem::path baseline_file(const std::filesystem::path& folder, const std::string& machine) {
  return folder / (machine + ".json");
}

Json make_baseline(const Json& timings, const Json& before, const BaselineOrigin& origin) {
  Json baseline;
  for (const char* key : kContext) {
    if (timings.at("context").contains(key)) baseline["context"][key] = timings["context"][key];
  }
  baseline["history"] = before.is_null() ? Json::array() : before.value("history", Json::array());
  baseline["benchmarks"] = Json::array();
  for (const Json& row : timings.at("benchmarks")) {
    const bool is_timing = row.value("run_type", "iteration") == "iteration";
    if (is_timing && !row.value("error_occurred", false)) baseline["benchmarks"].push_back(kept_row(row));
  }
  baseline["history"].push_back({{"date", origin.date},
                                 {"version", origin.version},
                                 {"commit", origin.commit},
                                 {"reason", origin.reason},
                                 {"seconds", medians(baseline["benchmarks"])}});
  return baseline;
}

void write_baseline(const std::filesystem::path& file, const Json& baseline) {
  std::string text = "{\n";
  text += fmt::format("  \"context\": {},\n", baseline.at("context").dump());
  for (const char* key : {"history", "benchmarks"}) {
    text += fmt::format("  \"{}\": [", key);
    std::string_view separator = "\n    ";
    for (const Json& entry : baseline.at(key)) {
      text += fmt::format("{}{}", separator, entry.dump());
      separator = ",\n    ";
    }
    text += key == std::string_view("history") ? "\n  ],\n" : "\n  ]\n}\n";
  }
  convergence::write_whole_file(file, text);
}

}  // namespace slipstick::bench
