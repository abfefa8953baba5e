#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// Text in files that others read.
namespace slipstick::convergence {

/// GitHub cuts a comment off above 64 kB.
inline constexpr std::size_t kMaxMarkdown = 64000;

/// The text with U+FFFD for each byte that is not UTF-8.
std::string as_utf8(const std::string& bytes);

/// Text in XML, between tags or in an attribute: markup is escaped; control characters are replaced as by
/// printable(), bytes that are not UTF-8 by U+FFFD.
std::string xml_text(std::string_view text);

/// A word of a shell command, quoted where necessary.
std::string shell_word(const std::string& text);

/// A user's text in Markdown, in a cell too: nothing in it becomes a link, an image, a mention of a person or
/// an issue, formatting or HTML; control characters as in XML.
std::string markdown_text(std::string_view text);

// ---------------------------------------------------------------- files of verdicts

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
std::string markdown_with_table(std::string text, std::string_view header, const std::vector<std::string>& rows,
                                std::string_view noun);

}  // namespace slipstick::convergence
