#include "convergence/gates/gate.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "convergence/results/markup.hpp"
#include "convergence/results/verdict_files.hpp"
#include "solver/input/input_file.hpp"

namespace slipstick::convergence {
namespace {

/// From the worst to the best.
constexpr std::array kSeverity{Outcome::failed,   Outcome::passed_unexpectedly, Outcome::refused,
                               Outcome::reported, Outcome::failed_as_expected,  Outcome::passed};

bool is_wrong(Outcome outcome) {
  return outcome == Outcome::failed || outcome == Outcome::passed_unexpectedly || outcome == Outcome::refused;
}

bool is_skipped(Outcome outcome) {
  return outcome == Outcome::reported || outcome == Outcome::failed_as_expected;
}

std::vector<const Judgement*> worst_first(const std::vector<Judgement>& judgements) {
  std::vector<const Judgement*> sorted;
  for (const Judgement& judgement : judgements) sorted.push_back(&judgement);
  const auto badness = [](const Judgement* judgement) {
    const auto severity =
        std::find(kSeverity.begin(), kSeverity.end(), judgement->outcome) - kSeverity.begin();
    return std::make_tuple(severity, -judgement->factor);
  };
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](const auto* a, const auto* b) { return badness(a) < badness(b); });
  return sorted;
}

long count(const std::vector<Judgement>& judgements, Outcome outcome) {
  return std::ranges::count(judgements, outcome, &Judgement::outcome);
}

/// In the words for published numbers, where it is one.
std::string outcome_text(const Judgement& judgement) {
  const std::string published = published_outcome(judgement);
  return published.empty() ? to_string(judgement.outcome) : published;
}

std::string counts_of(const std::vector<Judgement>& judgements) {
  std::vector<std::pair<std::string, long>> counts;
  for (auto outcome = kSeverity.rbegin(); outcome != kSeverity.rend(); ++outcome) {
    counts.emplace_back(to_string(*outcome), count(judgements, *outcome));
  }
  return counts_text("gate", counts);
}

/// A line where numbers of the literature are among them.
std::string published_counts(const std::vector<Judgement>& judgements) {
  std::map<std::string, int> counts;
  std::set<std::string> sources;
  for (const Judgement& judgement : judgements) {
    ++counts[published_outcome(judgement)];
    if (judgement.gate.published) sources.insert(judgement.gate.published->source);
  }
  if (sources.empty()) return "";
  return fmt::format(
      "published numbers of {} tables or equations: {} agree, {} differ for a known reason, {} cannot be "
      "compared at their digits, {} not compared\n",
      sources.size(), counts["agrees"], counts["differs"], counts["undecided"], counts["not compared"]);
}

std::string value_text(const Json& value) {
  if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
  return value.is_null() ? "-" : value.dump();
}

/// In the unit of the publication, where it is compared with one.
std::string value_text(const Judgement& judgement) {
  if (!judgement.gate.published) return value_text(judgement.value);
  const Json published = published_json(judgement);
  if (!published.contains("ours")) return "-";
  return fmt::format("{:.8g} (own error {:.2g} half units)", published["ours"].get<double>(),
                     published["own_error_half_units"].get<double>());
}

/// Whether the gate was read; a file that could not be has no quantity.
bool was_read(const Judgement& judgement) { return !judgement.gate.quantity.empty(); }

std::string factor_text(const Judgement& judgement) {
  return std::isfinite(judgement.factor) && judgement.gate.equals.is_null()
             ? fmt::format("{:.2g}", judgement.factor)
             : "-";
}

/// All there is to know of a gate that does not pass, a line each.
std::vector<std::string> explanation(const Judgement& judgement) {
  const Gate& gate = judgement.gate;
  std::vector<std::string> lines{judgement.why};
  const auto add = [&](const char* label, const std::string& text) {
    if (!text.empty()) lines.push_back(fmt::format("{}: {}", label, text));
  };
  add("likely to blame", judgement.dominant_error);
  add("why it matters", gate.reason);
  add("where the bound comes from", gate.basis);
  if (was_read(judgement)) add("again, alone", rerun_command(gate));
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
    junit.shown = fmt::format("{} = {}, must be {}", judgement.gate.quantity, value_text(judgement),
                              bound_text(judgement.gate));
  }
  if (is_skipped(judgement.outcome)) {
    junit.verdict = CaseVerdict::skipped;
    junit.message = fmt::format("{}: {}", to_string(judgement.outcome),
                                judgement.why.empty() ? junit.shown : judgement.why);
  } else if (is_wrong(judgement.outcome)) {
    junit.verdict = judgement.outcome == Outcome::refused ? CaseVerdict::error : CaseVerdict::failure;
    junit.details = fmt::format("{}", fmt::join(explanation(judgement), "\n"));
  }
  return junit;
}

std::string markdown_row(const Judgement& judgement) {
  const std::string remarks =
      judgement.outcome == Outcome::passed ? "" : fmt::format("{}", fmt::join(explanation(judgement), "\n"));
  return fmt::format("| {} | {} | {} | {} | {} | {} | {} |", outcome_text(judgement),
                     markdown_text(judgement.gate.id), markdown_text(judgement.gate.quantity),
                     markdown_text(value_text(judgement)),
                     was_read(judgement) ? markdown_text(bound_text(judgement.gate)) : "-",
                     factor_text(judgement), markdown_text(remarks));
}

Json judgement_json(const Judgement& judgement) {
  const Gate& gate = judgement.gate;
  Json json{{"id", gate.id},
            {"file", gate.file.string()},
            {"line", gate.line},
            {"outcome", to_string(judgement.outcome)}};
  if (was_read(judgement)) {
    json["quantity"] = gate.quantity;
    json["value"] = judgement.value;
    if (judgement.value.is_null()) json["value_reason"] = judgement.why;
    if (!gate.of.empty()) {
      json["of"] = gate.of.string();
      json["within"] = gate.within;
    }
    if (!judgement.file_date.empty()) json["file_date"] = judgement.file_date;
    if (gate.below) json["below"] = *gate.below;
    if (gate.above) json["above"] = *gate.above;
    if (!gate.equals.is_null()) json["equals"] = gate.equals;
    set_number(json, "factor", judgement.factor, "no number says how far it is from the bound");
    if (gate.published) json["published"] = published_json(judgement);
    json["basis"] = gate.basis;
    json["reason"] = gate.reason;
    json["rerun"] = rerun_command(gate);
  }
  json["why"] = judgement.why;
  if (!judgement.dominant_error.empty()) json["blame"] = judgement.dominant_error;
  return json;
}

}  // namespace

std::string gates_text(const std::vector<Judgement>& judgements) {
  std::size_t width = 0;
  for (const Judgement& judgement : judgements) width = std::max(width, judgement.gate.id.size());
  std::string text;
  std::string details;
  std::map<std::string, std::string> dates;
  for (const Judgement& judgement : judgements) {
    const Gate& gate = judgement.gate;
    if (!judgement.file_date.empty()) dates[gate.source.string()] = judgement.file_date;
    if (was_read(judgement)) {
      text += fmt::format("  {:<19} {:<{}}  {} = {}, {}\n", outcome_text(judgement), gate.id, width,
                          gate.quantity, value_text(judgement), bound_text(gate));
    }
    if (!is_wrong(judgement.outcome)) continue;
    details += fmt::format("\n{}: {}\n", to_string(judgement.outcome), gate.id);
    for (const std::string& line : explanation(judgement)) details += fmt::format("  {}\n", line);
  }
  for (const auto& [file, date] : dates) text += fmt::format("  {} is of {}\n", file, date);
  return text + details + published_counts(judgements) + counts_of(judgements) + "\n";
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
                             "| outcome | gate | quantity | value | must be | times the bound | |", rows,
                             "gates");
}

Json gates_json(const std::vector<Judgement>& judgements) {
  Json json;
  json["exit_code"] = exit_code(judgements);
  json["counts"] = Json::object();
  for (const Outcome outcome : kSeverity) json["counts"][to_string(outcome)] = count(judgements, outcome);
  json["gates"] = Json::array();
  for (const Judgement& judgement : judgements) json["gates"].push_back(judgement_json(judgement));
  return json;
}

}  // namespace slipstick::convergence
