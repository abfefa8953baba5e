#include "bench/scaling/crossovers.hpp"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "convergence/orders/crossover.hpp"

namespace slipstick::bench {
namespace {

using namespace convergence;

/// The slow one and the quick one of many cells.
constexpr std::array<std::pair<const char*, const char*>, 4> kRaces{
    {{"application/dense", "application/dcfft"},
     {"application/direct", "application/dcfft"},
     {"application/direct_2_threads", "application/dcfft_2_threads"},
     {"setup/dense", "setup/dcfft"}}};

Family family_of(const Json& sizes) {
  Family family;
  for (const Json& size : sizes) {
    SizedSeconds& sized = family.emplace_back(SizedSeconds{size[0], {}});
    for (const Json& one : size[1]) {
      if (one.is_number()) sized.seconds.push_back(one);
    }
  }
  return family;
}

Json crossover_json(const std::string& slow, const std::string& quick, const Crossover& crossover) {
  Json json{{"slow", slow}, {"quick", quick}};
  set_number(json, "cells", crossover.cells, crossover.remark);
  for (const auto& [key, bound] : {std::pair("low", crossover.low), std::pair("high", crossover.high)}) {
    set_number(json, key, bound, std::isnan(bound) ? crossover.remark : "outside the measured sizes");
  }
  json["remark"] = crossover.remark;
  return json;
}

}  // namespace

Json crossovers(const Json& seconds) {
  Json found = Json::array();
  for (const auto& [slow, quick] : kRaces) {
    if (!seconds.contains(slow) || !seconds.contains(quick)) continue;
    found.push_back(
        crossover_json(slow, quick, find_crossover(family_of(seconds[slow]), family_of(seconds[quick]))));
  }
  return found;
}

std::string crossovers_text(const Json& crossovers) {
  std::string text;
  for (const Json& crossing : crossovers) {
    const auto number = [&](const char* key) {
      const Json& found = crossing[key];
      return number_text(found.is_number() ? found.get<double>() : std::numeric_limits<double>::quiet_NaN(),
                         "{:.3g}");
    };
    text += fmt::format("{} is quicker than {} from {} cells a side on [{}, {}]{}\n",
                        crossing["quick"].get<std::string>(), crossing["slow"].get<std::string>(),
                        number("cells"), number("low"), number("high"),
                        crossing["cells"].is_number() ? "" : ": " + crossing["remark"].get<std::string>());
  }
  return text;
}

}  // namespace slipstick::bench
