#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "bench/compare/comparison.hpp"

/// The report of a comparison for a person, a CI server and a script.
namespace slipstick::bench {

/// All that a report shows.
struct ComparisonReport {
  std::string base;  ///< the files' names
  std::string now;
  ComparisonRules rules;
  Comparison comparison;             ///< includes the verdicts of the second run, if any
  std::optional<Comparison> second;  ///< of the benchmarks that looked slower
};

/// For a person: a table, the worst first, why times could not be judged, and the counts.
std::string comparison_text(const ComparisonReport& report);

/// The same as Markdown, shorter than kMaxMarkdown bytes: what does not fit is counted.
std::string comparison_markdown(const ComparisonReport& report);

/// JUnit's XML, as CI servers read it: one case for each benchmark and each obstacle. A slower or failed
/// benchmark is a failure, one that could not be judged an error.
std::string comparison_junit(const ComparisonReport& report);

/// Every number, in seconds.
nlohmann::ordered_json comparison_json(const ComparisonReport& report);

}  // namespace slipstick::bench
