#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Verdicts as CI servers read them: JUnit's XML, and tables in Markdown.
namespace slipstick::convergence {

enum class CaseVerdict { passed, skipped, failure, error };

struct JunitCase {
  std::string suite;
  std::string classname;
  std::string name;
  double seconds = 0.0;
  CaseVerdict verdict = CaseVerdict::passed;
  std::string type{};     ///< one word for the verdict; of failures and errors
  std::string message{};  ///< why it did not pass
  std::string details{};  ///< of failures and errors
  std::string shown{};    ///< the numbers, whatever the verdict
};

/// A suite for each name, in alphabetical order. Plain text everywhere: markup is escaped.
std::string junit_text(const std::string& title, const std::vector<JunitCase>& cases);

/// A text and a table below it, together shorter than kMaxMarkdown bytes: rows that do not fit are counted.
/// rows: each begins and ends with a bar; the worst come first. noun: "gates", in "7 more gates".
std::string markdown_with_table(std::string text, std::string_view header,
                                const std::vector<std::string>& rows, std::string_view noun);

/// "40 gates: 38 passed, 2 failed". counts: the number of each; zeros are not shown.
std::string counts_text(std::string_view noun, const std::vector<std::pair<std::string, long>>& counts);

}  // namespace slipstick::convergence
