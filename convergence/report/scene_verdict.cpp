#include "convergence/report/scene_verdict.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "convergence/hard/hard_run.hpp"
#include "convergence/report/scene_numbers.hpp"
#include "convergence/results/result_parts.hpp"
#include "convergence/runs/run_spec.hpp"
#include "solver/input/input_error.hpp"
#include "solver/solution.hpp"

namespace slipstick::convergence {
namespace {

/// An order's interval may end this far below the expected order.
constexpr double kWorseOrder = 0.25;
/// Complementarity gap of another program's pressure over its energy: other discretisations of the same
/// contact leave a thousandth.
constexpr double kOpenUnderPressure = 1e-2;

/// The error of a number and how it is known.
std::string error_text(const PageNumber& row) {
  const double error = std::abs(row.error);
  if (std::isnan(error)) return fmt::format("may be off by an unknown part ({})", row.basis);
  return fmt::format("{} off by {:.1e} ({})", std::isnan(row.mesh) ? "is" : "may be", error, row.basis);
}

/// The setting that reduces the larger part of an error to half of `wanted`.
std::string cure(const PageNumber& row, double wanted) {
  if (row.path > row.mesh) {
    return fmt::format("; set solver.substeps {:.0f} times as high, or use solve --accuracy {:g}",
                       std::ceil(2.0 * row.path / wanted), wanted);
  }
  return std::isnan(row.error) ? "" : "; increase grid.cells, and omit --quick";
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

/// The differences of two objects, a sentence each; `where` names the objects.
void compare(const Json& now, const Json& before, const std::string& where, std::vector<std::string>& found) {
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

/// "; family case: reason" of a hard case.
std::string case_text(const HardCase& made, const std::string& reason) {
  return fmt::format("; {} {}: {}", made.family, made.name, reason);
}

}  // namespace

Finding judge_certificate(const Json& answer) {
  const bool history = answer.contains("history");
  const double gap = number_at(answer, history ? "history.worst_gap" : "certificate.gap");
  const double allowed = std::max(number_at(answer, "tolerance"), number_at(answer, "certificate.rounding"));
  const bool paper = text_at(answer, "method") == "paper";
  const bool certified = is_converged(answer) && (paper ? std::isfinite(gap) : gap <= allowed);
  return {"Certificate",
          fmt::format("{}, {} x {} cells: gap/energy {:.1e}, {:.1e} allowed", text_at(answer, "status"),
                      number_at(answer, "cells[0]"), number_at(answer, "cells[1]"), gap, allowed),
          shown(certified)};
}

Finding judge_order(const StudyResult& study, const std::string& number, const std::string& words) {
  const auto open = [&](const std::string& why) {
    return Finding{"Orders", fmt::format("not shown by the {}: {}", words, why), Shown::open};
  };
  std::vector<std::string> paths{number + "_error", number};
  if (number == "twist_angle") paths.insert(paths.begin() + 1, "twist_error");
  for (const SeriesResult& series : study.series) {
    for (const std::string& path : paths) {
      const auto found = std::ranges::find(series.quantities, path, &QuantityResult::path);
      if (found == series.quantities.end()) continue;
      const Order& order = found->order;
      const double expected = found->expected.value;
      const bool preasymptotic = order.verdict == OrderVerdict::preasymptotic;
      const bool fitted =
          preasymptotic || order.verdict == OrderVerdict::asymptotic || order.verdict == OrderVerdict::superconvergent;
      if (!fitted || std::isnan(expected)) return open(order.why);
      const std::string line = fmt::format("of the {}: {}", words, order.why);
      if (order.high < expected - kWorseOrder) return {"Orders", line, Shown::fails};
      if (preasymptotic && !(order.low >= expected - kWorseOrder)) return open(order.why);
      return {"Orders", line};
    }
  }
  return open("there is no study of meshes with it");
}

Finding judge_hard(const HardResult& hard, const std::string& what) {
  const std::size_t wrong = hard.count(HardVerdict::wrong);
  const std::size_t not_converged = hard.count(HardVerdict::not_converged);
  std::string line = fmt::format("{} of {} certified, {} refused with a reason, {} not converged, {} wrong",
                                 hard.count(HardVerdict::certified), hard.rows.size(), hard.count(HardVerdict::refused),
                                 not_converged, wrong);
  for (const HardRow& row : hard.rows) {
    if (row.judged.verdict == HardVerdict::wrong || row.judged.verdict == HardVerdict::not_converged)
      line += case_text(row.hard, row.judged.reason);
  }
  return {what, line, shown(wrong == 0 && not_converged == 0)};
}

Finding judge_check(const Json& answer, const Json& check) {
  const std::string verdict = text_at(check, "verdict");
  const std::string why = fmt::format("{}: {}", verdict, text_at(check, "why"));
  if (is_converged(answer)) return {"Field", why, shown(verdict == "good")};
  return {"Field", fmt::format("not converged: {}; it is {}", text_at(answer, "message"), why), Shown::fails};
}

Finding judge_pressure(const Json& answer) {
  const double open = number_at(answer, "pressure_complementarity");
  return {"Pressure",
          fmt::format("its gap is open under {:.1e} of it, {:g} allowed; there are no tractions to judge", open,
                      kOpenUnderPressure),
          shown(std::abs(open) <= kOpenUnderPressure)};
}

Finding judge_hard_beside(const HardResult& hard) {
  const auto [agree, refuse, open, direction, answer] = hard.method_counts(0);
  std::string line =
      fmt::format("{} of {} agree with this program's, {} refused, {} not converged or failed, {} are other answers",
                  agree, hard.rows.size(), refuse, open, direction + answer);
  for (const HardRow& row : hard.rows) {
    const ComparedAnswer& found = row.methods.front().second;
    if (found.verdict == MethodVerdict::other_direction || found.verdict == MethodVerdict::other_answer)
      line += case_text(row.hard, found.reason);
  }
  return {"Hard variants", line, shown(direction + answer == 0)};
}

Finding judge_accuracy(const std::vector<PageNumber>& numbers, const std::string& number) {
  const PageNumber* const row = find_row(numbers, number);
  if (row == nullptr) return {"Accuracy", "the error of the answer is unknown", Shown::open};
  const bool holds = std::abs(row->error) <= solver::kPoorlyResolved;
  return {"Accuracy",
          fmt::format("the {} {}{}", row->words, error_text(*row), holds ? "" : cure(*row, solver::kPoorlyResolved)),
          holds ? Shown::holds : Shown::open};
}

WantedError read_wanted_error(const std::string& word) {
  const std::size_t at = std::min(word.find('='), word.size());
  const std::string number = word.substr(std::min(at + 1, word.size()));
  double error = kNaN;
  const auto [end, problem] = std::from_chars(number.data(), number.data() + number.size(), error);
  if (problem != std::errc() || end != number.data() + number.size() || !(error > 0.0 && error < 1.0)) {
    throw solver::InputError("--want", word, "no error",
                             "QUANTITY=ERROR with a relative error between 0 and 1, as twist=1e-3");
  }
  const std::string quantity = word.substr(0, at);
  return {quantity == "twist" ? "twist_angle" : quantity, error};
}

Finding judge_wanted(const WantedError& wanted, const std::vector<PageNumber>& numbers) {
  if (const PageNumber* const row = find_row(numbers, wanted.quantity)) {
    const bool holds = std::abs(row->error) <= wanted.error;
    return {fmt::format("Error of the {}", row->words),
            fmt::format("it {}, at most {:g} is allowed{}", error_text(*row), wanted.error,
                        holds ? "" : cure(*row, wanted.error)),
            shown(holds)};
  }
  std::vector<std::string> keys;
  for (const PageNumber& row : numbers) keys.push_back(row.key);
  throw solver::InputError("--want", wanted.quantity, "not a number of this result",
                           fmt::format("{}", fmt::join(keys, ", ")));
}

Headline headline_of(std::vector<Finding> findings, Json counts, const Page& page) {
  Headline headline{
      .findings = std::move(findings), .commit = text_at(page.provenance, "commit"), .counts = std::move(counts)};
  for (const PageNumber& row : page.numbers) headline.numbers.emplace_back(row.key, row.value);
  return headline;
}

std::vector<std::string> changes(const Headline& now, const Json& before) {
  std::vector<std::string> found;
  const std::string verdict = text_at(before, "verdict");
  if (now.verdict() != verdict) found.push_back(fmt::format("the verdict was {}", verdict));
  const Json json = to_json(now);
  for (const char* part : {"counts", "numbers"}) compare(json.at(part), before.at(part), "", found);
  return found;
}

Headline with_changes(Headline now, const Json& before) {
  if (before.is_null()) return now;
  now.changes = changes(now, before);
  now.since = text_at(before, "commit");
  if (now.changes.empty() && now.commit == now.since) {
    const Json since = before.value("since", Json{});
    now.since = since.is_null() ? "" : since.get<std::string>();
    now.changes = before.value("changes", now.changes);
  }
  return now;
}

std::string headline_text(const Headline& headline) {
  constexpr std::size_t kShownChanges = 3;
  const std::string verdict = headline.verdict();
  std::string text = verdict == "good" ? "All is well\n" : "NOT all is well\n";
  if (verdict == "open") {
    std::vector<std::string> open;
    for (const Finding& finding : headline.findings) {
      if (finding.shown == Shown::open) open.push_back(finding.what);
    }
    text = fmt::format("No finding fails, but open: {}\n", fmt::join(open, ", "));
  }
  const auto add = [&](const std::string& what, const std::string& line) {
    text += fmt::format("  {:<16} {}\n", what, line);
  };
  for (const Finding& finding : headline.findings) add(finding.what, finding.line);
  if (headline.since.empty()) return text;
  const std::vector<std::string>& found = headline.changes;
  const std::string since = "since the page of commit " + headline.since;
  if (found.empty()) add("Changes", "none " + since);
  for (std::size_t i = 0; i < std::min(found.size(), kShownChanges); ++i)
    add(i == 0 ? "Changes" : "", fmt::format("{}: {}", since, found[i]));
  if (found.size() > kShownChanges) add("", fmt::format("and {} more", found.size() - kShownChanges));
  return text;
}

std::vector<JunitCase> page_cases(const Page& page) {
  std::vector<JunitCase> cases;
  for (const auto& [what, line, shown] : page.headline.findings) {
    const bool holds = shown == Shown::holds;
    cases.push_back({.suite = page.scene.name,
                     .classname = "report",
                     .name = what,
                     .verdict = holds                   ? CaseVerdict::passed
                                : shown == Shown::fails ? CaseVerdict::failure
                                                        : CaseVerdict::skipped,
                     .type = "page",
                     .message = holds ? "" : line,
                     .shown = line});
  }
  return cases;
}

}  // namespace slipstick::convergence
