#include "convergence/results/verdict_files.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "convergence/results/markup.hpp"

namespace slipstick::convergence {
namespace {

std::string junit_counts(const std::vector<JunitCase>& cases) {
  const auto count = [&](CaseVerdict verdict) {
    return std::ranges::count(cases, verdict, &JunitCase::verdict);
  };
  double seconds = 0.0;
  for (const JunitCase& each : cases) seconds += each.seconds;
  return fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\" time=\"{:.3f}\"",
                     cases.size(), count(CaseVerdict::failure), count(CaseVerdict::error),
                     count(CaseVerdict::skipped), seconds);
}

std::string junit_verdict(const JunitCase& junit) {
  if (junit.verdict == CaseVerdict::passed) return "";
  if (junit.verdict == CaseVerdict::skipped) {
    return fmt::format("<skipped message=\"{}\"/>", xml_text(junit.message));
  }
  return fmt::format("<{0} message=\"{1}\" type=\"{2}\">{3}</{0}>",
                     junit.verdict == CaseVerdict::error ? "error" : "failure", xml_text(junit.message),
                     xml_text(junit.type), xml_text(junit.details));
}

}  // namespace

std::string junit_text(const std::string& title, const std::vector<JunitCase>& cases) {
  std::map<std::string, std::vector<JunitCase>> suites;
  for (const JunitCase& each : cases) suites[each.suite].push_back(each);
  std::string text = fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"{}\" {}>\n",
                                 xml_text(title), junit_counts(cases));
  for (const auto& [suite, own] : suites) {
    text += fmt::format("  <testsuite name=\"{}\" {}>\n", xml_text(suite), junit_counts(own));
    for (const JunitCase& each : own) {
      text += fmt::format(
          "    <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\">{}<system-out>{}</system-out>"
          "</testcase>\n",
          xml_text(each.classname), xml_text(each.name), each.seconds, junit_verdict(each),
          xml_text(each.shown));
    }
    text += "  </testsuite>\n";
  }
  return text + "</testsuites>\n";
}

std::string markdown_with_table(std::string text, std::string_view header,
                                const std::vector<std::string>& rows, std::string_view noun) {
  constexpr std::size_t kRoomForNote = 100;  // bytes
  text += fmt::format("{}\n|", header);
  for (auto bars = std::ranges::count(header, '|'); bars > 1; --bars) text += "---|";
  text += "\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (text.size() + rows[i].size() + kRoomForNote > kMaxMarkdown) {
      return text +
             fmt::format("\n{} more {}, none worse than these, are left out here.\n", rows.size() - i, noun);
    }
    text += rows[i] + "\n";
  }
  return text;
}

std::string counts_text(std::string_view noun, const std::vector<std::pair<std::string, long>>& counts) {
  std::vector<std::string> parts;
  long all = 0;
  for (const auto& [word, number] : counts) {
    all += number;
    if (number > 0) parts.push_back(fmt::format("{} {}", number, word));
  }
  return fmt::format("{} {}{}: {}", all, noun, all == 1 ? "" : "s", fmt::join(parts, ", "));
}

}  // namespace slipstick::convergence
