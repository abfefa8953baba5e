#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "bench/scaling/scaling_result.hpp"

namespace slipstick::bench {
namespace {

using Json = nlohmann::ordered_json;

std::string number(const Json& value, const char* format) {
  return value.is_number() ? fmt::format(fmt::runtime(format), value.get<double>()) : "-";
}

std::string interval(const Json& found, const char* format) {
  return fmt::format("[{}, {}]", number(found["low"], format), number(found["high"], format));
}

std::string word(const Json& value) { return value.is_string() ? value.get<std::string>() : "-"; }

}  // namespace

std::string scaling_text(const Json& scaling) {
  std::string text =
      fmt::format("{:<36} {:>5} {:<14} {:<10} {}\n", "time grows as N to the", "", "[95 %]", "by theory", "");
  for (const Json& family : scaling["families"]) {
    const Json& law = family["power_law"];
    if (!law["exponent"].is_number()) continue;
    text += fmt::format("  {:<34} {:>5} {:<14} {:<10} {}\n", family["name"].get<std::string>(),
                        number(law["exponent"], "{:.2f}"), interval(law, "{:.2f}"),
                        number(law["expected"], "{:.2f}"), word(law["theory"]));
  }
  return text + crossovers_text(scaling);
}

std::string crossovers_text(const Json& scaling) {
  std::string text;
  for (const Json& crossing : scaling["crossovers"]) {
    text += fmt::format("{} is quicker than {} from {} cells a side on {}{}\n",
                        crossing["quick"].get<std::string>(), crossing["slow"].get<std::string>(),
                        number(crossing["cells"], "{:.3g}"), interval(crossing, "{:.3g}"),
                        crossing["cells"].is_number() ? "" : ": " + crossing["remark"].get<std::string>());
  }
  return text;
}

}  // namespace slipstick::bench
