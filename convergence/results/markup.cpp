#include "convergence/results/markup.hpp"

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
  const auto is_plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || std::strchr("-._/+,:@", c) != nullptr;
  };
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

std::string markdown_cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\n') {
      escaped += "<br>";
    } else if (c == '<') {
      escaped += "&lt;";
    } else {
      if (c == '|' || c == '\\') escaped += '\\';
      escaped += c;
    }
  }
  return escaped;
}

}  // namespace slipstick::convergence
