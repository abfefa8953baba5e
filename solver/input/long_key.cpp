#include "solver/input/long_key.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <vector>

namespace slipstick::solver {
namespace {

/// Where the string or comment that begins at a place ends: the place behind it; the place itself where none
/// begins there.
std::size_t end_of_words(const std::string& text, std::size_t at) {
  const char quote = text[at];
  if (quote == '#') return std::min(text.find('\n', at), text.size());
  if (quote != '"' && quote != '\'') return at;
  const std::string lines(3, quote);
  const std::string end = text.compare(at, 3, lines) == 0 ? lines : std::string(1, quote);
  for (std::size_t i = at + end.size(); i < text.size(); ++i) {
    if (quote == '"' && text[i] == '\\') {
      ++i;
    } else if (text.compare(i, end.size(), end) == 0) {
      i += end.size();  // behind three quotes two more may stand, which belong to the string
      return end == lines ? std::min(text.find_first_not_of(quote, i), i + 2) : i;
    }
  }
  return text.size();
}

}  // namespace

std::ptrdiff_t line_of_long_key(const std::string& text) {
  struct Table {
    std::size_t around = 0;  ///< parts of the keys in front of all open braces
    std::size_t key = 1;     ///< of its key before the last '='
  };
  std::vector<Table> tables(1);
  std::size_t parts = 1;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::size_t behind = end_of_words(text, i);
    if (behind > i) {
      i = behind - 1;
      continue;
    }
    const char c = text[i];
    if (c == '.') ++parts;
    if (c == '=') tables.back().key = parts;
    if (c == '{') tables.push_back({.around = tables.back().around + tables.back().key});
    if (c == '}' && tables.size() > 1) tables.pop_back();
    const bool in_key = std::isalnum(static_cast<unsigned char>(c)) != 0 || std::strchr("._- \t", c) != nullptr;
    if (!in_key) parts = 1;
    if (tables.back().around + parts > kMaxKeyParts) {
      return 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(i), '\n');
    }
  }
  return 0;
}

}  // namespace slipstick::solver
