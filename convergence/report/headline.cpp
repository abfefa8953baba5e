#include "convergence/report/headline.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "convergence/results/result_parts.hpp"
#include "convergence/runs/failed_runs.hpp"

namespace slipstick::convergence {
namespace {

/// The paper's sphere at a load at which methods differ.
constexpr double kShownRatio = 0.9;

/// The errors, the gap and the time of the paper's sphere on its finest mesh.
Json headline_numbers(const Json& meshes) {
  const Json* finest = nullptr;
  for (const Json& row : meshes) {
    const bool shown =
        row["pressure"] == "solved" && std::abs(row["moment_ratio"].get<double>() - kShownRatio) < 1e-6;
    if (shown && (finest == nullptr || row["cells"][0] > (*finest)["cells"][0])) finest = &row;
  }
  if (finest == nullptr) return Json::object();
  Json found{{"moment_ratio", kShownRatio}, {"cells", (*finest)["cells"]}};
  for (const std::string key : {"twist_error", "stick_radius_error"}) {
    found[key] = (*finest)[key];
    if (found[key].is_null()) found[key + "_reason"] = (*finest)[key + "_reason"];
  }
  found["gap"] = (*finest)["certificate"]["gap"];
  found["seconds"] = (*finest)["seconds"]["total"];
  return found;
}

/// The passing gate that is nearest to its bound: {id, factor}; null where none has a bound in numbers.
Json nearest_to_bound(const Json& gates) {
  const Json* found = nullptr;
  for (const Json& gate : gates) {
    const bool counts = gate["outcome"] == "passed" && gate.contains("factor") && gate["factor"].is_number();
    if (counts && (found == nullptr || gate["factor"] > (*found)["factor"])) found = &gate;
  }
  return found == nullptr ? Json{} : Json{{"id", (*found)["id"]}, {"factor", (*found)["factor"]}};
}

/// Those that do not do as they should, by id.
Json gates_in_trouble(const Json& gates) {
  Json ids = Json::array();
  for (const Json& gate : gates) {
    for (const char* bad : {"failed", "passed unexpectedly", "refused"}) {
      if (gate["outcome"] == bad) ids.push_back(gate["id"]);
    }
  }
  return ids;
}

std::string joined(const Json& words) {
  std::string text;
  for (const Json& word : words) text += (text.empty() ? "" : ", ") + word.get<std::string>();
  return text;
}

std::string gates_line(const Json& gates) {
  if (gates.is_null()) return "left out of a quick page; make gate runs them";
  std::string line = fmt::format("{} of {} pass", gates["passed"].get<int>(), gates["total"].get<int>());
  if (const int expected = gates["expected_failures"]; expected > 0) {
    line += fmt::format(", {} fails as it should", expected);
  }
  if (!gates["trouble"].empty()) line += "; wrong: " + joined(gates["trouble"]);
  if (const Json& nearest = gates["nearest"]; !nearest.is_null()) {
    line += fmt::format("; nearest to its bound is {}, at {:.0f} % of it", nearest["id"].get<std::string>(),
                        100.0 * nearest["factor"].get<double>());
  }
  return line;
}

std::string hard_line(const Json& hard) {
  return fmt::format("{} of {} certified, {} refused with a reason, {} not converged, {} wrong",
                     hard["certified"].get<int>(), hard["total"].get<int>(), hard["refused"].get<int>(),
                     hard["not_converged"].get<int>(), hard["wrong"].get<int>());
}

std::string numbers_line(const Json& numbers) {
  const auto text = [&](const char* key, const char* look) {
    return numbers[key].is_number() ? fmt::format(fmt::runtime(look), numbers[key].get<double>())
                                    : std::string("unknown");
  };
  return fmt::format("M/M_lim = {}, {} x {} cells: twist off by {}, stick radius by {}, gap {}, {} s",
                     text("moment_ratio", "{}"), numbers["cells"][0].get<int>(),
                     numbers["cells"][1].get<int>(), text("twist_error", "{:.1e}"),
                     text("stick_radius_error", "{:.1e}"), text("gap", "{:.1e}"), text("seconds", "{:.2g}"));
}

std::string peers_line(const Json& peers) {
  std::string line;
  for (const Json& peer : peers) {
    line += fmt::format("{}{} is {}", line.empty() ? "" : ", ", peer["program"].get<std::string>(),
                        peer["verdict"].get<std::string>());
    if (peer["verdict"] != peer["expected"])
      line += fmt::format(" (known to be {})", peer["expected"].get<std::string>());
  }
  return line;
}

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

Json headline(const Json& report) {
  bool good = true;
  Json counts;
  counts["gates"] = nullptr;
  if (report.contains("gates")) {
    const Json& all = report["gates"];
    counts["gates"] = {{"total", all["gates"].size()},
                       {"passed", all["counts"]["passed"]},
                       {"expected_failures", all["counts"]["failed as expected"]},
                       {"trouble", gates_in_trouble(all["gates"])},
                       {"nearest", nearest_to_bound(all["gates"])}};
    good = good && all["exit_code"] == 0;
  } else {
    counts["gates_reason"] = "left out of a quick page";
  }
  counts["hard"]["total"] = report["hard"]["rows"].size();
  for (const char* verdict : {"certified", "refused", "not_converged", "wrong"}) {
    counts["hard"][verdict] = report["hard"]["counts"][verdict];
  }
  good = good && counts["hard"]["wrong"] == 0 && counts["hard"]["not_converged"] == 0;
  int failed = 0;
  for (const Json& study : report["studies"]) failed += failed_runs_text(study).empty() ? 0 : 1;
  counts["failed_studies"] = failed;
  counts["peers"] = Json::object();
  for (const Json& peer : report["peers"]) {
    counts["peers"][peer["program"].get<std::string>()] = peer["verdict"];
    good = good && peer["verdict"] == peer["expected"];
  }
  const Json numbers = headline_numbers(report["mesh"]);
  Json lines = Json::array();
  const auto add = [&](const char* what, const std::string& line) { lines.push_back({what, line}); };
  add("Gates", gates_line(counts["gates"]));
  add("Hard cases", hard_line(counts["hard"]));
  if (failed > 0) add("Studies", fmt::format("{} have runs that failed", failed));
  if (!report["peers"].empty()) add("Other programs", peers_line(report["peers"]));
  return {{"verdict", good && failed == 0 ? "good" : "bad"},
          {"commit", report["provenance"]["commit"]},
          {"lines", lines},
          {"numbers", numbers},
          {"counts", counts}};
}

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
    text += fmt::format("  {:<15} {}\n", what, line);
  };
  for (const Json& line : headline["lines"]) add(line[0].get<std::string>(), line[1].get<std::string>());
  if (const Json& numbers = headline["numbers"]; numbers.contains("twist_error"))
    add("Paper's sphere", numbers_line(numbers));
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
