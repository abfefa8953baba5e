#include "convergence/report/headline.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace slipstick::convergence {
namespace {

/// Whether two values differ by more than machines and clocks do.
bool differs(const Json& now, const Json& before) {
  constexpr double kSpread = 0.01;
  if (!now.is_number_float() || !before.is_number_float()) return now != before;
  const double one = now;
  const double other = before;
  return !(std::abs(one - other) <= kSpread * std::max(std::abs(one), std::abs(other)));
}

std::string value_text(const Json& value) {
  if (value.is_number_float()) return fmt::format("{:.2e}", value.get<double>());
  if (value.is_null()) return "none";
  return value.is_string() ? value.get<std::string>() : value.dump();
}

/// What stands in one of two objects with another value, sentence by sentence; `where` names the objects.
void compare(const Json& now, const Json& before, const std::string& where, Json& found) {
  for (const auto& [key, value] : now.items()) {
    std::string name = where + key;
    std::ranges::replace(name, '_', ' ');
    const Json old = before.is_object() && before.contains(key) ? before[key] : Json{};
    if (key == "seconds" || key.ends_with("_reason")) continue;
    if (value.is_object() && old.is_object()) {
      compare(value, old, name + " ", found);
    } else if (value.is_object() || old.is_object()) {  // a part of the page
      found.push_back(fmt::format("{}: left out {}", name, value.is_object() ? "before" : "now"));
    } else if (differs(value, old)) {
      found.push_back(fmt::format("{}: {} before, {} now", name, value_text(old), value_text(value)));
    }
  }
}

}  // namespace

Json changes(const Json& now, const Json& before) {
  Json found = Json::array();
  if (differs(now["verdict"], before["verdict"])) {
    found.push_back(fmt::format("the verdict was {}", value_text(before["verdict"])));
  }
  compare(now["counts"], before["counts"], "", found);
  compare(now["numbers"], before["numbers"], "", found);
  return found;
}

Json with_changes(Json now, const Json& before) {
  if (before.is_null()) {
    now["since"] = nullptr;
    now["since_reason"] = "the first page in its folder";
    now["changes"] = Json::array();
    return now;
  }
  now["changes"] = changes(now, before);
  now["since"] = before["commit"];
  if (now["changes"].empty() && now["commit"] == before["commit"]) {
    for (const char* key : {"since", "since_reason", "changes"}) {
      if (before.contains(key)) now[key] = before[key];
    }
  }
  return now;
}

std::string headline_text(const Json& headline) {
  constexpr std::size_t kShownChanges = 3;
  std::string text = headline["verdict"] == "good" ? "All is well\n" : "NOT all is well\n";
  const auto add = [&](const std::string& what, const std::string& line) {
    text += fmt::format("  {:<16} {}\n", what, line);
  };
  for (const Json& line : headline["lines"]) add(line[0].get<std::string>(), line[1].get<std::string>());
  if (headline["since"].is_null()) return text;
  const std::string since = headline["since"];
  const Json& found = headline["changes"];
  if (found.empty()) add("Changes", fmt::format("none since the page of commit {}", since));
  for (std::size_t i = 0; i < std::min(found.size(), kShownChanges); ++i) {
    add(i == 0 ? "Changes" : "",
        fmt::format("since the page of commit {}: {}", since, found[i].get<std::string>()));
  }
  if (found.size() > kShownChanges) add("", fmt::format("and {} more", found.size() - kShownChanges));
  return text;
}

}  // namespace slipstick::convergence
