#include "bench/compare/comparison_report.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "convergence/results/markup.hpp"
#include "convergence/results/result_parts.hpp"

namespace slipstick::bench {
namespace {

using convergence::CaseVerdict;
using convergence::JunitCase;
using convergence::markdown_text;
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

/// With the chance that it is none, where that says something.
std::string verdict_text(const ComparedBenchmark& benchmark) {
  if (benchmark.finding == Finding::same && benchmark.low > 1.0) return benchmark.remark;
  const bool has_chance = is_failure(benchmark.finding) || benchmark.finding == Finding::undecided ||
                          benchmark.finding == Finding::quicker;
  return has_chance && std::isfinite(benchmark.p_value)
             ? fmt::format("{} (p {:.1g})", to_string(benchmark.finding), benchmark.p_value)
             : to_string(benchmark.finding);
}

const std::string kObstacle = "could not judge: ";

using Row = std::array<std::string, 6>;

Row row_of(const ComparedBenchmark& benchmark) {
  return {benchmark.name,
          seconds_text(benchmark.base_seconds),
          seconds_text(benchmark.new_seconds),
          std::isfinite(benchmark.ratio) ? fmt::format("{:.3f}", benchmark.ratio) : "-",
          std::isfinite(benchmark.low) ? fmt::format("{:.3f} to {:.3f}", benchmark.low, benchmark.high) : "-",
          verdict_text(benchmark)};
}

const Row kHeader{"benchmark", "base", "new", "new/base", "95 % interval", "verdict"};

std::string table(const std::vector<ComparedBenchmark>& benchmarks) {
  std::size_t width = kHeader[0].size();
  for (const ComparedBenchmark& benchmark : benchmarks) width = std::max(width, benchmark.name.size());
  const auto line = [&](const Row& row) {
    return fmt::format("  {:<{}}  {:>8}  {:>8}  {:>8}  {:>14}  {}\n", row[0], width, row[1], row[2], row[3],
                       row[4], row[5]);
  };
  std::string text = line(kHeader);
  for (const ComparedBenchmark& benchmark : benchmarks) {
    const Row row = row_of(benchmark);
    text += line(row);
    if (!benchmark.remark.empty() && benchmark.remark != row.back())
      text += "      " + benchmark.remark + "\n";
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
  convergence::set_number(json, "low", benchmark.low, no_interval);
  convergence::set_number(json, "high", benchmark.high, no_interval);
  convergence::set_number(json, "p_value", benchmark.p_value, no_times);
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
  for (const std::string& obstacle : report.comparison.obstacles) text += kObstacle + obstacle + "\n";
  return text + fmt::format("{} ({})\n", counts_of(report.comparison.benchmarks), rules_text(report.rules));
}

std::string comparison_markdown(const ComparisonReport& report) {
  std::string text = fmt::format("### {}\n\n{}; {}.\n\n", counts_of(report.comparison.benchmarks),
                                 markdown_text(heading(report)), rules_text(report.rules));
  for (const std::string& obstacle : report.comparison.obstacles) {
    text += fmt::format("- {}{}\n", kObstacle, markdown_text(obstacle));
  }
  std::vector<std::string> rows;
  for (const ComparedBenchmark& benchmark : worst_first(report.comparison.benchmarks)) {
    Row row = row_of(benchmark);
    row[0] = markdown_text(row[0]);
    rows.push_back(fmt::format("| {} | {} |", fmt::join(row, " | "), markdown_text(benchmark.remark)));
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
  json["benchmarks"] = benchmarks_json(comparison);
  if (report.second) json["second_run"] = benchmarks_json(*report.second);
  return json;
}

}  // namespace slipstick::bench
