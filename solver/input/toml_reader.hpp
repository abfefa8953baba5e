#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace slipstick::solver {

/// Words as scene files have them, each with its meaning.
template <typename Value>
using Words = std::vector<std::pair<std::string, Value>>;

template <typename Value>
std::string word_of(const Words<Value>& words, Value value) {
  for (const auto& [word, meaning] : words) {
    if (meaning == value) return word;
  }
  throw std::logic_error("a value without a word");
}

/// What a number may be, in words and as a test; the test is false for NaN.
struct Range {
  std::string words;
  std::function<bool(double)> contains;
};

inline const Range kPositive{"positive and finite", [](double x) { return x > 0.0 && std::isfinite(x); }};
inline const Range kNotNegative{"zero or positive, finite",
                                [](double x) { return x >= 0.0 && std::isfinite(x); }};
inline const Range kFinite{"finite", [](double x) { return std::isfinite(x); }};
/// Whole numbers from low to high.
Range whole(double low, double high);

/// A TOML file whose keys are asked for one by one, by dotted path; an index picks one of an array of tables,
/// as in step[1].twist. Each question says what is allowed; reject_unknown() at the end finds the keys that
/// nobody asked for. Throws InputError.
class SceneReader {
 public:
  SceneReader(const std::filesystem::path& file, const std::vector<std::string>& overrides);

  /// Where one of several keys that exclude each other is overridden, those that the file has instead are
  /// dropped.
  void prefer_overridden(const std::vector<std::string>& alternatives);

  bool has(const std::string& key);
  bool is_overridden(const std::string& key) const { return overridden_.contains(key); }
  bool is_array(const std::string& key);
  bool is_text(const std::string& key);
  /// The line on which a key or a table stands; 0 where it is missing.
  std::size_t line(const std::string& key) const;
  /// Tables in the array of tables under a key; none where the key is missing.
  std::size_t count(const std::string& key);
  std::optional<double> find_number(const std::string& key, const Range& range);
  double number(const std::string& key, const Range& range);
  double number_or(const std::string& key, double otherwise, const Range& range);
  std::optional<std::array<double, 2>> find_pair(const std::string& key, const Range& range);
  std::array<double, 2> pair(const std::string& key, const Range& range);
  /// All numbers of a list, at least one; none where the key is missing.
  std::vector<double> numbers(const std::string& key, const Range& range);
  /// The elements of a list, at least one, as TOML writes them; none where the key is missing.
  std::vector<std::string> list(const std::string& key);
  bool flag_or(const std::string& key, bool otherwise);
  /// What a table holds, as overrides: "key=value" with dotted keys, whatever they are; none where the table
  /// is missing.
  std::vector<std::string> assignments(const std::string& key);
  std::string text(const std::string& key);
  std::string text_or(const std::string& key, const std::string& otherwise);
  std::filesystem::path path(const std::string& key);

  /// One of some words, each with its meaning.
  template <typename Value>
  Value choice(const std::string& key, const Words<Value>& words) {
    const std::string word = text(key);
    std::vector<std::string> allowed;
    for (const auto& [name, value] : words) {
      if (name == word) return value;
      allowed.push_back(name);
    }
    fail_choice(key, word, allowed);
  }
  template <typename Value>
  Value choice_or(const std::string& key, Value otherwise, const Words<Value>& words) {
    return has(key) ? choice(key, words) : otherwise;
  }

  void reject_unknown() const;
  [[noreturn]] void fail(const std::string& key, const std::string& value, const std::string& allowed) const;

 private:
  [[noreturn]] void fail_missing(const std::string& key, const std::string& allowed) const;
  [[noreturn]] void fail_unknown(const std::string& key) const;
  [[noreturn]] void fail_choice(const std::string& key, const std::string& word,
                                const std::vector<std::string>& allowed) const;
  void apply_override(const std::string& assignment);
  std::string where(const std::string& key) const;

  std::filesystem::path file_;
  struct Questions;  ///< the parsed file, and the keys that were asked for
  std::shared_ptr<Questions> toml_;
  std::set<std::string> overridden_;
};

}  // namespace slipstick::solver
