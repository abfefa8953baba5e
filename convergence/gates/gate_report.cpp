#include "convergence/gates/gate_report.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <variant>

#include "convergence/results/markup.hpp"
#include "solver/input/input_file.hpp"

namespace slipstick::convergence {
namespace {

/// From the worst to the best.
constexpr std::array kSeverity{Outcome::failed,   Outcome::passed_unexpectedly, Outcome::refused,
                               Outcome::reported, Outcome::failed_as_expected,  Outcome::passed};

bool is_wrong(Outcome outcome) {
  return outcome == Outcome::failed || outcome == Outcome::passed_unexpectedly || outcome == Outcome::refused;
}

bool is_skipped(Outcome outcome) { return outcome == Outcome::reported || outcome == Outcome::failed_as_expected; }

std::vector<const Judgement*> worst_first(const std::vector<Judgement>& judgements) {
  std::vector<const Judgement*> sorted;
  for (const Judgement& judgement : judgements) sorted.push_back(&judgement);
  std::ranges::stable_sort(sorted, {}, [](const Judgement* judgement) {
    return std::pair(std::ranges::find(kSeverity, judgement->outcome), -judgement->factor);
  });
  return sorted;
}

long count(const std::vector<Judgement>& judgements, Outcome outcome) {
  return std::ranges::count(judgements, outcome, &Judgement::outcome);
}

/// The outcome, or how a published number compares.
std::string outcome_text(const Judgement& judgement) {
  const std::optional<Comparison> comparison = comparison_of(judgement);
  return comparison ? to_string(*comparison) : to_string(judgement.outcome);
}

/// "40 gates: 38 passed, 2 failed"; zeros are not shown.
std::string counts_of(const std::vector<Judgement>& judgements) {
  std::vector<std::string> parts;
  for (auto outcome = kSeverity.rbegin(); outcome != kSeverity.rend(); ++outcome) {
    const long number = count(judgements, *outcome);
    if (number > 0) parts.push_back(fmt::format("{} {}", number, to_string(*outcome)));
  }
  return fmt::format("{} gate{}: {}", judgements.size(), judgements.size() == 1 ? "" : "s", fmt::join(parts, ", "));
}

/// One line on the published numbers; empty where there are none.
std::string published_counts(const std::vector<Judgement>& judgements) {
  std::map<std::optional<Comparison>, int> counts;
  std::set<std::string> sources;
  for (const Judgement& judgement : judgements) {
    ++counts[comparison_of(judgement)];
    if (const auto* const published = std::get_if<Published>(&judgement.gate.bound)) sources.insert(published->source);
  }
  if (sources.empty()) return "";
  return fmt::format(
      "published numbers of {} tables or equations: {} agree, {} differ for a known reason, {} cannot be "
      "compared at their digits, {} not compared\n",
      sources.size(), counts[Comparison::agrees], counts[Comparison::differs], counts[Comparison::undecided],
      counts[Comparison::not_compared]);
}

std::string value_text(const Json& value) {
  if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
  return value.is_null() ? "-" : value.dump();
}

/// The value; for a published number in the unit of the publication, with its error.
std::string value_text(const Judgement& judgement) {
  if (!std::holds_alternative<Published>(judgement.gate.bound)) return value_text(judgement.value);
  const std::optional<OwnNumber> ours = own_number(judgement);
  return ours ? fmt::format("{:.8g} (own error {:.2g} half units)", ours->value, ours->half_units) : "-";
}

/// The file that a gate's number comes from.
std::string source_name(const Gate& gate) {
  const std::string name = file_of(gate.source).lexically_normal().string();
  return name.empty() ? "-" : name;
}

/// False for a gate file that could not be read.
bool was_read(const Judgement& judgement) { return !judgement.gate.quantity.empty(); }

std::string factor_text(const Judgement& judgement) {
  return std::isfinite(judgement.factor) && !std::holds_alternative<Equals>(judgement.gate.bound)
             ? fmt::format("{:.2g}", judgement.factor)
             : "-";
}

/// The details of a gate that does not pass, one in each line.
std::vector<std::string> explanation(const Judgement& judgement) {
  const Gate& gate = judgement.gate;
  std::vector<std::string> lines{judgement.why};
  const auto add = [&](const char* label, const std::string& text) {
    if (!text.empty()) lines.push_back(fmt::format("{}: {}", label, text));
  };
  add("largest part of the error", judgement.dominant_error);
  add("why it matters", gate.reason);
  add("origin of the bound", gate.basis);
  if (was_read(judgement)) add("to repeat this gate", rerun_command(gate));
  return lines;
}

JunitCase junit_case(const Judgement& judgement) {
  JunitCase junit{.suite = judgement.gate.file.string(),
                  .classname = judgement.gate.file.stem().string(),
                  .name = judgement.gate.id,
                  .seconds = judgement.seconds,
                  .type = to_string(judgement.outcome),
                  .message = judgement.why};
  if (was_read(judgement)) {
    junit.shown =
        fmt::format("{} = {}, must be {}", judgement.gate.quantity, value_text(judgement), bound_text(judgement));
  }
  if (is_skipped(judgement.outcome)) {
    junit.verdict = CaseVerdict::skipped;
    junit.message =
        fmt::format("{}: {}", to_string(judgement.outcome), judgement.why.empty() ? junit.shown : judgement.why);
  } else if (is_wrong(judgement.outcome)) {
    junit.verdict = judgement.outcome == Outcome::refused ? CaseVerdict::error : CaseVerdict::failure;
    junit.details = fmt::format("{}", fmt::join(explanation(judgement), "\n"));
  }
  return junit;
}

std::string markdown_row(const Judgement& judgement) {
  const std::string remarks =
      judgement.outcome == Outcome::passed ? "" : fmt::format("{}", fmt::join(explanation(judgement), "\n"));
  return fmt::format("| {} | {} | {} | {} | {} | {} | {} |", outcome_text(judgement), markdown_text(judgement.gate.id),
                     markdown_text(judgement.gate.quantity), markdown_text(value_text(judgement)),
                     was_read(judgement) ? markdown_text(bound_text(judgement)) : "-", factor_text(judgement),
                     markdown_text(remarks));
}

/// The bound as keys of a gate's row: below, above, equals, of and within.
Json bound_json(const Judgement& judgement) {
  const Bound& bound = judgement.gate.bound;
  if (const auto* const equals = std::get_if<Equals>(&bound)) return {{"equals", equals->value}};
  Json json = Json::object();
  if (!judgement.interval) return json;
  const auto [low, high] = *judgement.interval;
  if (std::isfinite(high)) json.emplace("below", high);
  if (std::isfinite(low) && !std::holds_alternative<Below>(bound)) json.emplace("above", low);
  return json;
}

}  // namespace

void to_json(Json& json, const Judgement& judgement) {
  const Gate& gate = judgement.gate;
  json = {
      {"id", gate.id}, {"file", gate.file.string()}, {"line", gate.line}, {"outcome", to_string(judgement.outcome)}};
  if (was_read(judgement)) {
    json.update(Json{{"quantity", gate.quantity}, {"value", judgement.value}});
    if (judgement.value.is_null()) json.emplace("value_reason", judgement.why);
    if (const auto* const relative = std::get_if<RelativeTo>(&gate.bound))
      json.update(Json{{"of", relative->file.string()}, {"within", relative->within}});
    if (!judgement.file_date.empty()) json.emplace("file_date", judgement.file_date);
    json.update(bound_json(judgement));
    set_number(json, "factor", judgement.factor, "there is no number to compare with the bound");
    if (std::holds_alternative<Published>(gate.bound)) json.emplace("published", published_json(judgement));
    json.update(Json{{"basis", gate.basis}, {"reason", gate.reason}, {"rerun", rerun_command(gate)}});
  }
  json.emplace("why", judgement.why);
  if (!judgement.dominant_error.empty()) json.emplace("blame", judgement.dominant_error);
}

std::string gates_text(const std::vector<Judgement>& judgements) {
  std::size_t width = 0;
  for (const Judgement& judgement : judgements) width = std::max(width, judgement.gate.id.size());
  std::string text;
  std::string details;
  std::map<std::string, std::string> dates;
  for (const Judgement& judgement : judgements) {
    const Gate& gate = judgement.gate;
    if (!judgement.file_date.empty()) dates[file_of(gate.source).string()] = judgement.file_date;
    if (was_read(judgement)) {
      text += fmt::format("  {:<19} {:<{}}  {} = {}, {}\n", outcome_text(judgement), gate.id, width, gate.quantity,
                          value_text(judgement), bound_text(judgement));
    }
    if (!is_wrong(judgement.outcome)) continue;
    details += fmt::format("\n{}: {}\n", to_string(judgement.outcome), gate.id);
    for (const std::string& line : explanation(judgement)) details += fmt::format("  {}\n", line);
  }
  for (const auto& [file, date] : dates) text += fmt::format("  {} was changed on {}\n", file, date);
  return text + details + published_counts(judgements) + counts_of(judgements) + "\n";
}

std::string list_text(const std::vector<Judgement>& gates) {
  std::string text;
  std::size_t ids = 0;
  std::size_t sources = 0;
  for (const Judgement& each : gates) {
    ids = std::max(ids, each.gate.id.size());
    sources = std::max(sources, source_name(each.gate).size());
  }
  for (const Judgement& each : gates) {
    const Gate& gate = each.gate;
    text += was_read(each) ? fmt::format("  {:<{}}  {:<{}}  {}, {}\n", gate.id, ids, source_name(gate), sources,
                                         gate.quantity, bound_text(each))
                           : fmt::format("  {}: {}\n", gate.id, each.why);
  }
  return text + fmt::format("{} gate{}\n", gates.size(), gates.size() == 1 ? "" : "s");
}

Json list_json(const std::vector<Judgement>& gates) {
  Json rows = Json::array();
  for (const Judgement& each : gates) {
    Json& row = rows.emplace_back(each);
    if (!was_read(each)) continue;
    for (const char* const of_verdict : {"outcome", "value", "value_reason", "factor", "factor_reason", "why"})
      row.erase(of_verdict);
    constexpr std::array kSources{"", "scene", "study", "result"};
    if (const std::string name = source_name(each.gate); name != "-")
      row.emplace(kSources.at(each.gate.source.index()), name);
    if (const auto* const scene = std::get_if<SceneSource>(&each.gate.source)) row.emplace("set", scene->overrides);
    if (const auto* const study = std::get_if<StudySource>(&each.gate.source)) row.emplace("set", study->overrides);
  }
  return {{"listed", rows}};
}

std::string gates_junit(const std::vector<Judgement>& judgements) {
  std::vector<JunitCase> cases;
  cases.reserve(judgements.size());
  for (const Judgement& judgement : judgements) cases.push_back(junit_case(judgement));
  return junit_text("slipstick gates", cases);
}

std::string gates_markdown(const std::vector<Judgement>& judgements) {
  std::vector<std::string> rows;
  for (const Judgement* const judgement : worst_first(judgements)) rows.push_back(markdown_row(*judgement));
  return markdown_with_table(fmt::format("### {}\n\n", counts_of(judgements)),
                             "| outcome | gate | quantity | value | must be | times the bound | |", rows, "gates");
}

Json counts_json(const std::vector<Judgement>& judgements) {
  Json counts = Json::object();
  for (const Outcome outcome : kSeverity) counts.emplace(to_string(outcome), count(judgements, outcome));
  return counts;
}

Json gates_json(const std::vector<Judgement>& judgements) {
  return {{"exit_code", exit_code(judgements)}, {"counts", counts_json(judgements)}, {"gates", judgements}};
}

}  // namespace slipstick::convergence
