#include "convergence/results/markup.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "solver/input/input_file.hpp"

namespace slipstick::convergence {

std::string as_utf8(const std::string& bytes) {
  using Json = nlohmann::json;
  return Json::parse(Json(bytes).dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::string xml_text(std::string_view text) {
  constexpr std::string_view kNoCharacter = "\xef\xbf";  // before 0xbe and 0xbf in UTF-8: U+FFFE, U+FFFF
  static const std::map<char, std::string> kMarkup{{'&', "&amp;"},  {'<', "&lt;"},   {'>', "&gt;"},
                                                   {'"', "&quot;"}, {'\n', "&#10;"}, {'\t', "&#9;"}};
  std::string escaped;
  for (const char c : as_utf8(solver::printable(text))) {
    if (escaped.ends_with(kNoCharacter) && (c == '\xbe' || c == '\xbf')) {
      escaped.replace(escaped.size() - kNoCharacter.size(), kNoCharacter.size(), "?");
      continue;
    }
    const auto markup = kMarkup.find(c);
    escaped += markup == kMarkup.end() ? std::string(1, c) : markup->second;
  }
  return escaped;
}

std::string shell_word(const std::string& text) {
  const auto is_plain = [](unsigned char c) { return std::isalnum(c) != 0 || std::strchr("-._/+,:@", c) != nullptr; };
  if (std::all_of(text.begin(), text.end(), is_plain)) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

std::string markdown_text(std::string_view text) {
  static const std::map<char, std::string> kMarkup{
      {'&', "&amp;"}, {'<', "&lt;"}, {'\n', "<br>"}, {'@', "@&#8203;"}, {'#', "#&#8203;"}};
  constexpr std::string_view kLinks = "/.";  // of http:// and www., which a server makes links of
  std::string escaped;
  for (const char c : as_utf8(solver::printable(text))) {
    const auto markup = kMarkup.find(c);
    if (std::strchr("\\`*_[]|~", c) != nullptr) escaped += '\\';
    if (kLinks.find(c) != std::string_view::npos && (escaped.ends_with(":") || escaped.ends_with("www")))
      escaped += "&#8203;";  // a blank without width
    escaped += markup == kMarkup.end() ? std::string(1, c) : markup->second;
  }
  return escaped;
}

namespace {

std::string junit_counts(const std::vector<JunitCase>& cases) {
  const auto count = [&](CaseVerdict verdict) { return std::ranges::count(cases, verdict, &JunitCase::verdict); };
  double seconds = 0.0;
  for (const JunitCase& each : cases) seconds += each.seconds;
  return fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\" time=\"{:.3f}\"", cases.size(),
                     count(CaseVerdict::failure), count(CaseVerdict::error), count(CaseVerdict::skipped), seconds);
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
          xml_text(each.classname), xml_text(each.name), each.seconds, junit_verdict(each), xml_text(each.shown));
    }
    text += "  </testsuite>\n";
  }
  return text + "</testsuites>\n";
}

std::string markdown_with_table(std::string text, std::string_view header, const std::vector<std::string>& rows,
                                std::string_view noun) {
  constexpr std::size_t kRoomForNote = 100;  // bytes
  text += fmt::format("{}\n|", header);
  for (auto bars = std::ranges::count(header, '|'); bars > 1; --bars) text += "---|";
  text += "\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (text.size() + rows[i].size() + kRoomForNote > kMaxMarkdown) {
      return text + fmt::format("\n{} more {}, none worse than these, are left out here.\n", rows.size() - i, noun);
    }
    text += rows[i] + "\n";
  }
  return text;
}

}  // namespace slipstick::convergence
