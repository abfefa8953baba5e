#include "solver/input/setting_key.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace slipstick::solver {

Range whole(double low, double high) {
  return {fmt::format("a whole number from {:g} to {:g}", low, high),
          [low, high](double x) { return x >= low && x <= high && x == std::floor(x); }};
}

std::string without_indices(const std::string& key) {
  std::string name;
  bool index = false;
  for (const char c : key) {
    index = (index || c == '[') && c != ']';
    if (!index && c != ']') name += c;
  }
  return name;
}

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitute = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitute});
    }
  }
  return row.back();
}

std::string nearest_word(const std::string& word, const std::vector<std::string>& known) {
  // Compare only a prefix of long words: the distance costs the product of the lengths.
  constexpr std::size_t kMaxCompared = 100;
  const std::string compared = word.substr(0, kMaxCompared);
  const auto nearest = std::min_element(known.begin(), known.end(), [&](const auto& a, const auto& b) {
    return edit_distance(compared, a) < edit_distance(compared, b);
  });
  return nearest == known.end() ? "" : *nearest;
}

}  // namespace slipstick::solver
