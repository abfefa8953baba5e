#include "convergence/report/scene_verdict.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "convergence/orders/mesh_sequence.hpp"
#include "convergence/results/quantity.hpp"
#include "convergence/runs/failed_runs.hpp"
#include "solver/input/input_error.hpp"
#include "solver/solution.hpp"

namespace slipstick::convergence {
namespace {

/// An order's interval may end this far below the expected order.
constexpr double kWorseOrder = 0.25;
/// Complementarity gap of another program's pressure over its energy: other discretisations of the same
/// contact leave a thousandth.
constexpr double kOpenUnderPressure = 1e-2;

/// The passing gate that is nearest to its bound; null where none has a bound in numbers.
const Json* nearest_to_bound(const Json& gates) {
  const Json* found = nullptr;
  for (const Json& gate : gates) {
    const bool counts = gate["outcome"] == "passed" && gate.contains("factor") && gate["factor"].is_number();
    if (counts && (found == nullptr || gate["factor"] > (*found)["factor"])) found = &gate;
  }
  return found;
}

/// Names those that are not as they should be.
std::string wrong_gates(const Json& gates) {
  std::string line;
  for (const Json& gate : gates) {
    const Json& outcome = gate["outcome"];
    if (outcome == "failed" || outcome == "passed unexpectedly" || outcome == "refused") {
      line += fmt::format("; {} {}", gate["id"].get<std::string>(), outcome.get<std::string>());
    }
  }
  return line;
}

Finding judge_literature(const Json& all) {
  const Json& counts = all["counts"];
  return {
      "Literature",
      fmt::format("{} of {} published numbers agree at their digits, {} differ for a known reason",
                  counts["passed"].get<int>(), all["gates"].size(), counts["failed as expected"].get<int>()) +
          wrong_gates(all["gates"]),
      shown(all["exit_code"] == 0)};
}

Finding judge_gates(const Json& all) {
  const Json& gates = all["gates"];
  std::string line = fmt::format("{} of {} pass", all["counts"]["passed"].get<int>(), gates.size());
  if (const int expected = all["counts"]["failed as expected"]; expected > 0) {
    line += fmt::format(", {} fails as it should", expected);
  }
  line += wrong_gates(gates);
  if (const Json* const nearest = nearest_to_bound(gates); nearest != nullptr) {
    line += fmt::format("; nearest to its bound is {}, at {:.0f} % of it",
                        (*nearest)["id"].get<std::string>(), 100.0 * (*nearest)["factor"].get<double>());
  }
  return {"Gates", line, shown(all["exit_code"] == 0)};
}

Finding judge_known_fields(const Json& peers) {
  Finding found{"Fields of others", ""};
  for (const Json& peer : peers) {
    found.line += fmt::format("{}{} is {}", found.line.empty() ? "" : ", ",
                              peer["program"].get<std::string>(), peer["verdict"].get<std::string>());
    if (peer["verdict"] == peer["expected"]) continue;
    found.line += fmt::format(" (known to be {})", peer["expected"].get<std::string>());
    found.shown = Shown::fails;
  }
  return found;
}

/// How far a number of the page may be off, and how that is known.
std::string error_text(const Json& row) {
  const std::string basis = row["basis"];
  const double error = size_at(row, "error");
  if (std::isnan(error)) return fmt::format("may be off by an unknown part ({})", basis);
  return fmt::format("{} off by {:.1e} ({})", row["mesh"].is_null() ? "is" : "may be", error, basis);
}

/// The setting that makes the larger part of an error as small as half of what is wanted.
std::string cure(const Json& row, double wanted) {
  const double path = number_at(row, "path");
  if (path > number_at(row, "mesh")) {
    return fmt::format("; set solver.substeps {:.0f} times as high, or see what solve --accuracy {:g} takes",
                       std::ceil(2.0 * path / wanted), wanted);
  }
  if (row["error"].is_null()) return "";
  return "; take more grid.cells, and a page without --quick";
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

Finding judge_certificate(const Json& answer) {
  const bool history = answer.contains("history");
  const double gap = number_at(answer, history ? "history.worst_gap" : "certificate.gap");
  const double allowed = std::max(number_at(answer, "tolerance"), number_at(answer, "certificate.rounding"));
  const bool paper = answer["method"] == "paper";
  const bool certified = is_converged(answer) && (paper ? std::isfinite(gap) : gap <= allowed);
  return {"Certificate",
          fmt::format("{}, {} x {} cells: gap/energy {:.1e}, {:.1e} allowed",
                      is_converged(answer) ? "converged" : answer["status"].get<std::string>(),
                      answer["cells"][0].get<int>(), answer["cells"][1].get<int>(), gap, allowed),
          shown(certified)};
}

Finding judge_order(const Json& studies, const std::string& number, const std::string& words) {
  const auto open = [&](const std::string& why) {
    return Finding{"Orders", fmt::format("not shown by the {}: {}", words, why), Shown::open};
  };
  for (const Json& series : studies.front()["series"]) {
    for (const std::string& quantity : {number + "_error", std::string("twist_error"), number}) {
      if (!series["order"].contains(quantity) || (quantity == "twist_error" && number != "twist_angle"))
        continue;
      const Json& order = series["order"][quantity];
      const std::string verdict = order["verdict"];
      const std::string why = order["why"];
      const double expected = number_at(order, "expected");
      const bool fitted =
          verdict == "asymptotic" || verdict == "superconvergent" || verdict == "preasymptotic";
      if (!fitted || std::isnan(expected)) return open(why);
      const std::string line = fmt::format("of the {}: {}", words, why);
      if (number_at(order, "high") < expected - kWorseOrder) return {"Orders", line, Shown::fails};
      const bool reaches = verdict != "preasymptotic" || number_at(order, "low") >= expected - kWorseOrder;
      if (!reaches) return open(why);
      return {"Orders", line};
    }
  }
  return open("there is no study of meshes with it");
}

Finding judge_hard(const Json& hard, const std::string& what) {
  const Json& counts = hard["counts"];
  std::string line =
      fmt::format("{} of {} certified, {} refused with a reason, {} not converged, {} wrong",
                  counts["certified"].get<int>(), hard["rows"].size(), counts["refused"].get<int>(),
                  counts["not_converged"].get<int>(), counts["wrong"].get<int>());
  for (const Json& row : hard["rows"]) {
    if (row["verdict"] == "wrong" || row["verdict"] == "not_converged") {
      line += fmt::format("; {} {}: {}", row["family"].get<std::string>(), row["case"].get<std::string>(),
                          row["reason"].get<std::string>());
    }
  }
  return {what, line, shown(counts["wrong"] == 0 && counts["not_converged"] == 0)};
}

Finding judge_check(const Json& answer, const Json& check) {
  const bool good = check["verdict"] == "good";
  const std::string why =
      fmt::format("{}: {}", check["verdict"].get<std::string>(), check["why"].get<std::string>());
  if (is_converged(answer)) return {"Field", why, shown(good)};
  return {"Field", fmt::format("not converged: {}; it is {}", answer["message"].get<std::string>(), why),
          Shown::fails};
}

Finding judge_pressure(const Json& answer) {
  const double open = number_at(answer, "pressure_complementarity");
  return {"Pressure",
          fmt::format("its gap is open under {:.1e} of it, {:g} allowed; there are no tractions to judge",
                      open, kOpenUnderPressure),
          shown(std::abs(open) <= kOpenUnderPressure)};
}

Finding judge_hard_beside(const Json& hard) {
  const std::string name = hard["methods"].begin().key();
  const Json& counts = hard["methods"][name];
  const int other = counts["other_direction"].get<int>() + counts["other_answer"].get<int>();
  std::string line = fmt::format(
      "{} of {} agree with this program's, {} refused, {} not converged or failed, {} are other answers",
      counts["agrees"].get<int>(), hard["rows"].size(), counts["refused"].get<int>(),
      counts["not_converged"].get<int>(), other);
  for (const Json& row : hard["rows"]) {
    const Json& beside = row["methods"][name];
    if (beside["verdict"] != "other_direction" && beside["verdict"] != "other_answer") continue;
    line += fmt::format("; {} {}: {}", row["family"].get<std::string>(), row["case"].get<std::string>(),
                        beside["reason"].get<std::string>());
  }
  return {"Hard variants", line, shown(other == 0)};
}

Finding judge_accuracy(const Json& numbers, const std::string& number) {
  for (const Json& row : numbers) {
    if (row["key"] != number) continue;
    const double error = size_at(row, "error");
    const Shown found = error <= solver::kPoorlyResolved ? Shown::holds : Shown::open;
    return {"Accuracy",
            fmt::format("the {} {}{}", row["words"].get<std::string>(), error_text(row),
                        found == Shown::holds ? "" : cure(row, solver::kPoorlyResolved)),
            found};
  }
  return {"Accuracy", "how far the answer may be off is not known", Shown::open};
}

Finding judge_wanted(const WantedError& wanted, const Json& numbers) {
  for (const Json& row : numbers) {
    if (row["key"] != wanted.quantity) continue;
    const bool holds = size_at(row, "error") <= wanted.error;
    return {fmt::format("Error of the {}", row["words"].get<std::string>()),
            fmt::format("it {}, {:g} wanted{}", error_text(row), wanted.error,
                        holds ? "" : cure(row, wanted.error)),
            shown(holds)};
  }
  std::vector<std::string> keys;
  for (const Json& row : numbers) keys.push_back(row["key"]);
  throw solver::InputError("--want", wanted.quantity, "not a number of this result",
                           fmt::format("{}", fmt::join(keys, ", ")));
}

std::vector<Finding> judge_validation(const Json& paper) {
  Finding gates{"Gates", "left out of a quick page; make gate runs them"};
  if (paper.contains("gates")) gates = judge_gates(paper["gates"]);
  return {std::move(gates), judge_hard(paper["hard"], "Hard scenes"), judge_known_fields(paper["peers"]),
          judge_literature(paper["literature"])};
}

Json headline_of(const std::vector<Finding>& findings, const Json& page) {
  constexpr const char* kChecks[] = {"holds", "open", "fails"};
  constexpr const char* kVerdicts[] = {"good", "open", "bad"};
  Shown worst = Shown::holds;
  Json lines = Json::array();
  Json checks = Json::object();
  for (const auto& [what, line, found] : findings) {
    worst = std::max(worst, found);
    lines.push_back({what, line});
    checks[what] = kChecks[static_cast<int>(found)];
  }
  Json counts{{"checks", checks}};
  if (page.contains("hard")) counts["hard"] = page["hard"]["counts"];
  if (page.contains("paper")) {
    const Json& paper = page["paper"];
    counts["hard_scenes"] = paper["hard"]["counts"];
    counts["gates"] = nullptr;
    counts["gates_reason"] = "left out of a quick page";
    if (paper.contains("gates")) {
      counts["gates"] = paper["gates"]["counts"];
      counts.erase("gates_reason");
    }
  }
  Json numbers = Json::object();
  for (const Json& row : page["numbers"]) numbers[row["key"].get<std::string>()] = row["value"];
  return {{"verdict", kVerdicts[static_cast<int>(worst)]},
          {"commit", page["provenance"]["commit"]},
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
  const std::string verdict = headline["verdict"];
  std::string text = verdict == "good" ? "All is well\n" : "NOT all is well\n";
  if (verdict == "open") {
    std::vector<std::string> open;
    for (const auto& [what, found] : headline["counts"]["checks"].items()) {
      if (found == "open") open.push_back(what);
    }
    text = fmt::format("Nothing is wrong, but open: {}\n", fmt::join(open, ", "));
  }
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
