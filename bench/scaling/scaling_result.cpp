#include "bench/scaling/scaling_result.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "convergence/orders/growth.hpp"
#include "convergence/results/result_parts.hpp"

namespace slipstick::bench {
namespace {

using namespace convergence;

/// "a/cells:8/b" is the family "a/b" at 8 cells.
std::optional<std::pair<std::string, double>> family_and_cells(const std::string& name) {
  constexpr std::string_view kKey = "/cells:";
  const auto at = ("/" + name).find(kKey);
  if (at == std::string::npos) return {};
  const auto digits = at + kKey.size() - 1;
  const auto end = std::min(name.find('/', digits), name.size());
  const std::string number = name.substr(digits, end - digits);
  if (number.empty() || number.size() > 9 || number.find_first_not_of("0123456789") != std::string::npos) {
    return {};
  }
  std::string family = name.substr(0, at == 0 ? 0 : at - 1) + name.substr(end);
  if (family.starts_with('/')) family.erase(0, 1);
  return std::pair{family, std::stod(number)};
}

/// A family's benchmarks, smallest size first.
using Members = std::map<double, const TimedBenchmark*>;

Family family_of(const Members& members) {
  Family family;
  for (const auto& [cells, benchmark] : members) {
    SizedSeconds sized{cells, {}};
    if (benchmark->error.empty()) {
      for (const Timing& timing : benchmark->timings) sized.seconds.push_back(timing.real);
    }
    family.push_back(sized);
  }
  return family;
}

constexpr const char* kNoTheory = "no theory is known here";

/// The growth by theory, by the beginning of a family's name.
constexpr std::array<std::pair<std::string_view, Growth>, 10> kTheory{
    {{"application/dense", Growth::n4},
     {"application/direct", Growth::n4},
     {"application/dcfft", Growth::n2_log_n},
     {"four_bare_transforms", Growth::n2_log_n},
     {"influence/", Growth::n2},
     {"setup/dense", Growth::n4},
     {"setup/direct", Growth::n2},
     {"setup/dcfft", Growth::n2_log_n},
     {"normal/", Growth::n2_log_n},
     {"solve/coulomb", Growth::n2_log_n}}};

/// The slow one and the quick one of many cells.
constexpr std::array<std::pair<const char*, const char*>, 4> kRaces{
    {{"application/dense", "application/dcfft"},
     {"application/direct", "application/dcfft"},
     {"application/direct_2_threads", "application/dcfft_2_threads"},
     {"setup/dense", "setup/dcfft"}}};

Json row_json(double cells, const TimedBenchmark& benchmark, const SizedSeconds& sized) {
  const TypicalSeconds time = typical(sized.seconds);
  const std::string none = benchmark.error.empty() ? "no repetition has a time" : benchmark.error;
  Json row{{"cells", cells}};
  set_number(row, "seconds", time.seconds, none);
  set_number(row, "low", time.low, std::isnan(time.seconds) ? none : "one repetition");
  set_number(row, "high", time.high, std::isnan(time.seconds) ? none : "one repetition");
  row["repetitions"] = std::ranges::count_if(sized.seconds, is_valid_time);
  const auto error = benchmark.counters.contains("error") ? benchmark.counters.find("error")
                                                          : benchmark.counters.find("twist_error");
  set_number(row, "error", error == benchmark.counters.end() ? kNaN : error->second,
             "the benchmark has no such counter");
  row["counters"] = benchmark.counters;
  return row;
}

std::optional<Growth> theory_of(const std::string& family) {
  for (const auto& [name, growth] : kTheory) {
    if (family.starts_with(name)) return growth;
  }
  return {};
}

/// Adds the exponent of theory's growth between the same sizes.
Json power_law_json(const PowerLaw& law, std::optional<Growth> theory) {
  Json json;
  set_number(json, "exponent", law.exponent, law.why_not);
  set_number(json, "low", law.low, law.why_not);
  set_number(json, "high", law.high, law.why_not);
  set_number(json, "constant", law.constant, law.why_not);
  double expected = kNaN;
  if (theory && !law.cells.empty()) {
    const double ratio = grown(*theory, law.cells.back()) / grown(*theory, law.cells.front());
    expected = std::log(ratio) / std::log(law.cells.back() / law.cells.front());
  }
  if (theory) {
    json["theory"] = to_string(*theory);
  } else {
    set_missing(json, "theory", kNoTheory);
  }
  set_number(json, "expected", expected, theory ? law.why_not : kNoTheory);
  json["cells"] = law.cells;
  return json;
}

Json family_json(const std::string& name, const Members& members) {
  const Family family = family_of(members);
  const std::optional<Growth> theory = theory_of(name);
  Json rows = Json::array();
  for (const SizedSeconds& sized : family) {
    rows.push_back(row_json(sized.cells, *members.at(sized.cells), sized));
  }
  return {{"name", name}, {"rows", rows}, {"power_law", power_law_json(fit_power_law(family), theory)}};
}

Json crossover_json(const std::string& slow, const std::string& quick, const Crossover& crossover) {
  Json json{{"slow", slow}, {"quick", quick}};
  const auto outside = [&](double bound) {
    return std::isnan(bound) ? crossover.remark : "outside the measured sizes";
  };
  set_number(json, "cells", crossover.cells, crossover.remark);
  set_number(json, "low", crossover.low, outside(crossover.low));
  set_number(json, "high", crossover.high, outside(crossover.high));
  json["remark"] = crossover.remark;
  return json;
}

}  // namespace

Json scaling_json(const Timings& timings) {
  std::vector<std::string> order;
  std::map<std::string, Members> families;
  for (const TimedBenchmark& benchmark : timings.benchmarks) {
    const auto place = family_and_cells(benchmark.name);
    if (!place) continue;
    if (!families.contains(place->first)) order.push_back(place->first);
    families[place->first][place->second] = &benchmark;
  }
  Json json{{"families", Json::array()}, {"crossovers", Json::array()}};
  for (const std::string& name : order) json["families"].push_back(family_json(name, families.at(name)));
  for (const auto& [slow, quick] : kRaces) {
    if (!families.contains(slow) || !families.contains(quick)) continue;
    json["crossovers"].push_back(crossover_json(
        slow, quick, find_crossover(family_of(families.at(slow)), family_of(families.at(quick)))));
  }
  return json;
}

std::string crossovers_text(const Json& scaling) {
  const auto number = [](const Json& value) { return convergence::number_text(value, "{:.3g}"); };
  std::string text;
  for (const Json& crossing : scaling["crossovers"]) {
    text += fmt::format("{} is quicker than {} from {} cells a side on [{}, {}]{}\n",
                        crossing["quick"].get<std::string>(), crossing["slow"].get<std::string>(),
                        number(crossing["cells"]), number(crossing["low"]), number(crossing["high"]),
                        crossing["cells"].is_number() ? "" : ": " + crossing["remark"].get<std::string>());
  }
  return text;
}

}  // namespace slipstick::bench
