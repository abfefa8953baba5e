#include "bench/compare/comparison_report.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "convergence/results/markup.hpp"
#include "convergence/results/result_parts.hpp"
#include "convergence/results/verdict_files.hpp"

namespace slipstick::bench {
namespace {

using convergence::CaseVerdict;
using convergence::JunitCase;
using convergence::markdown_cell;
using Json = nlohmann::ordered_json;

/// From the worst to the best.
constexpr std::array kSeverity{
    Finding::slower,    Finding::failed,  Finding::undecided,  Finding::only_in_base, Finding::only_in_new,
    Finding::not_timed, Finding::too_few, Finding::not_judged, Finding::quicker,      Finding::same};

std::vector<ComparedBenchmark> worst_first(std::vector<ComparedBenchmark> benchmarks) {
  std::ranges::stable_sort(benchmarks, {}, [](const ComparedBenchmark& benchmark) {
    return std::pair(std::ranges::find(kSeverity, benchmark.finding),
                     std::isnan(benchmark.ratio) ? 0.0 : -benchmark.ratio);
  });
  return benchmarks;
}

auto count(const std::vector<ComparedBenchmark>& benchmarks, Finding finding) {
  return std::ranges::count(benchmarks, finding, &ComparedBenchmark::finding);
}

std::string counts_of(const std::vector<ComparedBenchmark>& benchmarks) {
  std::vector<std::pair<std::string, long>> counts;
  for (auto finding = kSeverity.rbegin(); finding != kSeverity.rend(); ++finding) {
    counts.emplace_back(to_string(*finding), count(benchmarks, *finding));
  }
  return convergence::counts_text("benchmark", counts);
}

std::string seconds_text(double seconds) {
  if (!std::isfinite(seconds)) return "-";
  constexpr std::array<std::pair<double, std::string_view>, 4> units{
      {{1.0, "s"}, {1e-3, "ms"}, {1e-6, "µs"}, {1e-9, "ns"}}};
  for (const auto& [size, unit] : units) {
    if (seconds >= size) return fmt::format("{:.4g} {}", seconds / size, unit);
  }
  return fmt::format("{:.3g} ns", seconds / units.back().first);
}

std::string ratio_text(double ratio) { return std::isfinite(ratio) ? fmt::format("{:.3f}", ratio) : "-"; }

bool has_interval(const ComparedBenchmark& benchmark) {
  return benchmark.low > 0.0 && std::isfinite(benchmark.high);
}

std::string interval_text(const ComparedBenchmark& benchmark) {
  return has_interval(benchmark) ? fmt::format("{:.3f} to {:.3f}", benchmark.low, benchmark.high) : "-";
}

/// With the chance that it is none, where that says something.
std::string verdict_text(const ComparedBenchmark& benchmark) {
  if (benchmark.finding == Finding::same && benchmark.low > 1.0) return benchmark.remark;
  const bool has_chance = is_failure(benchmark.finding) || benchmark.finding == Finding::undecided ||
                          benchmark.finding == Finding::quicker;
  return has_chance && std::isfinite(benchmark.p_value)
             ? fmt::format("{} (p {:.1g})", to_string(benchmark.finding), benchmark.p_value)
             : to_string(benchmark.finding);
}

using Row = std::array<std::string, 6>;

Row row_of(const ComparedBenchmark& benchmark) {
  return {benchmark.name,
          seconds_text(benchmark.base_seconds),
          seconds_text(benchmark.new_seconds),
          ratio_text(benchmark.ratio),
          interval_text(benchmark),
          verdict_text(benchmark)};
}

const Row kHeader{"benchmark", "base", "new", "new/base", "95 % interval", "verdict"};

/// The number of letters in UTF-8.
std::size_t letters(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](unsigned char c) { return (c & 0xC0U) != 0x80U; }));
}

std::string table(const std::vector<ComparedBenchmark>& benchmarks) {
  std::vector<Row> rows{kHeader};
  for (const ComparedBenchmark& benchmark : benchmarks) rows.push_back(row_of(benchmark));
  std::array<std::size_t, 6> widths{};
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], letters(row[i]));
  }
  std::string text;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const Row& row = rows[r];
    text += fmt::format("  {:<{}}", row[0], widths[0]);  // fmt pads by letters too
    for (std::size_t i = 1; i + 1 < row.size(); ++i) text += fmt::format("  {:>{}}", row[i], widths[i]);
    text += "  " + row.back() + "\n";
    if (r > 0 && !benchmarks[r - 1].remark.empty() && benchmarks[r - 1].remark != row.back())
      text += "      " + benchmarks[r - 1].remark + "\n";
  }
  return text;
}

std::string heading(const ComparisonReport& report) {
  return fmt::format("{} against {}, {}", report.now, report.base,
                     report.comparison.paired ? "repetition by repetition" : "as independent runs");
}

/// The rules of a verdict in words.
std::string rules_text(const ComparisonRules& rules) {
  return fmt::format("what counts: {:.3g} % or more, by chance in {:.3g} of 100 such comparisons at most",
                     100.0 * rules.effect, 100.0 * rules.level);
}

/// The slowdown that is found nine times in ten: in the benchmark in the middle, and in the one that scatters
/// most.
std::string power_text(const std::vector<ComparedBenchmark>& benchmarks) {
  std::vector<std::pair<double, std::string>> found;
  for (const ComparedBenchmark& benchmark : benchmarks) {
    if (benchmark.smallest_found > 1.0) found.emplace_back(benchmark.smallest_found, benchmark.name);
  }
  if (found.empty()) return "";
  std::ranges::sort(found);
  const auto percent = [](double ratio) {
    return std::isfinite(ratio) ? fmt::format("from {:.3g} % on", 100.0 * (ratio - 1.0)) : "never";
  };
  return fmt::format("so many repetitions find a slowdown nine times in ten {} (median), in {} {}",
                     percent(found[found.size() / 2].first), found.back().second,
                     percent(found.back().first));
}

/// Notes that a reader needs beside the table, a paragraph each.
std::vector<std::string> notes(const ComparisonReport& report) {
  std::vector<std::string> lines;
  for (const std::string& obstacle : report.comparison.obstacles) {
    lines.push_back("could not judge: " + obstacle);
  }
  for (const std::string& remark : report.comparison.remarks) lines.push_back(remark);
  if (const std::string power = power_text(report.comparison.benchmarks); !power.empty())
    lines.push_back(power);
  if (!report.second && !suspicious(report.comparison).empty()) {
    lines.push_back(
        "this is one run only: let --rerun 'PROGRAM --benchmark_filter={filter} --benchmark_format=json "
        "--benchmark_repetitions=N' run the suspicious ones again before they count");
  }
  return lines;
}

JunitCase junit_case(const std::string& suite, const ComparedBenchmark& benchmark) {
  const Row row = row_of(benchmark);
  JunitCase junit{.suite = suite,
                  .classname = "compare",
                  .name = benchmark.name,
                  .seconds = std::isfinite(benchmark.new_seconds) ? benchmark.new_seconds : 0.0,
                  .type = to_string(benchmark.finding),
                  .shown = fmt::format("base {}, new {}, new/base {} ({})", row[1], row[2], row[3], row[4])};
  if (!is_fine(benchmark.finding)) {
    junit.verdict = is_failure(benchmark.finding) ? CaseVerdict::failure : CaseVerdict::error;
    junit.message = verdict_text(benchmark) + (benchmark.remark.empty() ? "" : ": " + benchmark.remark);
    junit.details = junit.shown;
  }
  return junit;
}

Json benchmark_json(const ComparedBenchmark& benchmark) {
  const std::string no_times = "no times to compare";
  const std::string no_interval =
      std::isfinite(benchmark.ratio) ? "too few repetitions for an interval" : no_times;
  Json json{{"name", benchmark.name}, {"finding", to_string(benchmark.finding)}};
  convergence::set_number(json, "base_seconds", benchmark.base_seconds, "no time");
  convergence::set_number(json, "new_seconds", benchmark.new_seconds, "no time");
  convergence::set_number(json, "ratio", benchmark.ratio, no_times);
  if (has_interval(benchmark)) {
    json["low"] = benchmark.low;
    json["high"] = benchmark.high;
  } else {
    convergence::set_missing(json, "low", no_interval);
    convergence::set_missing(json, "high", no_interval);
  }
  convergence::set_number(json, "p_value", benchmark.p_value, no_times);
  convergence::set_number(json, "smallest_found", benchmark.smallest_found,
                          std::isfinite(benchmark.ratio) ? "too few repetitions to find any" : no_times);
  json["base_repetitions"] = benchmark.base_repetitions;
  json["new_repetitions"] = benchmark.new_repetitions;
  json["remark"] = benchmark.remark;
  return json;
}

Json benchmarks_json(const Comparison& comparison) {
  Json list = Json::array();
  for (const ComparedBenchmark& benchmark : comparison.benchmarks) list.push_back(benchmark_json(benchmark));
  return list;
}

}  // namespace

std::string comparison_text(const ComparisonReport& report) {
  std::string text = heading(report) + "\n" + table(worst_first(report.comparison.benchmarks));
  if (report.second && !report.second->benchmarks.empty()) {
    text += "the suspicious ones, run again\n" + table(worst_first(report.second->benchmarks));
  }
  for (const std::string& note : notes(report)) text += note + "\n";
  return text + fmt::format("{} ({})\n", counts_of(report.comparison.benchmarks), rules_text(report.rules));
}

std::string comparison_markdown(const ComparisonReport& report) {
  std::string text = fmt::format("### {}\n\n{}; {}.\n\n", counts_of(report.comparison.benchmarks),
                                 markdown_cell(heading(report)), rules_text(report.rules));
  for (const std::string& note : notes(report)) text += fmt::format("- {}\n", markdown_cell(note));
  std::vector<std::string> rows;
  for (const ComparedBenchmark& benchmark : worst_first(report.comparison.benchmarks)) {
    Row row = row_of(benchmark);
    row[0] = markdown_cell(row[0]);
    rows.push_back(fmt::format("| {} | {} |", fmt::join(row, " | "), markdown_cell(benchmark.remark)));
  }
  return convergence::markdown_with_table(text + "\n", fmt::format("| {} | |", fmt::join(kHeader, " | ")),
                                          rows, "benchmarks");
}

std::string comparison_junit(const ComparisonReport& report) {
  const std::string suite = heading(report);
  std::vector<JunitCase> cases;
  for (const std::string& obstacle : report.comparison.obstacles) {
    cases.push_back({.suite = suite,
                     .classname = "compare",
                     .name = fmt::format("obstacle {}", cases.size() + 1),
                     .verdict = CaseVerdict::error,
                     .type = "obstacle",
                     .message = obstacle});
  }
  for (const ComparedBenchmark& benchmark : report.comparison.benchmarks) {
    cases.push_back(junit_case(suite, benchmark));
  }
  return convergence::junit_text("slipstick compare", cases);
}

Json comparison_json(const ComparisonReport& report) {
  const Comparison& comparison = report.comparison;
  Json json{
      {"exit_code", exit_code(comparison)}, {"base", report.base},         {"new", report.now},
      {"effect", report.rules.effect},      {"level", report.rules.level}, {"paired", comparison.paired}};
  json["counts"] = Json::object();
  for (const Finding finding : kSeverity) {
    json["counts"][to_string(finding)] = count(comparison.benchmarks, finding);
  }
  json["obstacles"] = comparison.obstacles;
  json["remarks"] = comparison.remarks;
  json["benchmarks"] = benchmarks_json(comparison);
  if (report.second) json["second_run"] = benchmarks_json(*report.second);
  return json;
}

}  // namespace slipstick::bench
