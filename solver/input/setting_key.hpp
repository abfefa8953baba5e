#pragma once

#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace slipstick::solver {

/// Words as settings files have them, each with its meaning.
template <typename Value>
using Words = std::vector<std::pair<std::string, Value>>;

template <typename Value>
std::string word_of(const Words<Value>& words, Value value) {
  for (const auto& [word, meaning] : words) {
    if (meaning == value) return word;
  }
  throw std::logic_error("a value without a word");
}

/// The numbers that a key allows, in words and as a test; the test is false for NaN.
struct Range {
  std::string words;
  std::function<bool(double)> contains;
};

inline const Range kPositive{"positive and finite", [](double x) { return x > 0.0 && std::isfinite(x); }};
inline const Range kNotNegative{"zero or positive, finite", [](double x) { return x >= 0.0 && std::isfinite(x); }};
inline const Range kFinite{"finite", [](double x) { return std::isfinite(x); }};
/// Whole numbers from low to high.
Range whole(double low, double high);

/// The type of a key's value.
enum class KeyType { number, pair, numbers, word, text, texts, file, flag, values, table, tables };

/// A key of a settings file. Its reader takes from here what is allowed, and the reference shows all of it.
struct SettingKey {
  std::string name;  ///< dotted; in an array of tables without an index, as step.moment
  KeyType type;
  std::string unit;                      ///< empty where it has none
  std::string otherwise;                 ///< the default, as TOML has it or in words; or kRequired
  Range allowed;                         ///< of numbers; of words, their list
  std::string meaning;                   ///< one sentence
  std::vector<std::string> shapes = {};  ///< of the indenter, that have it; empty: it depends on no shape
};
using SettingKeys = std::vector<SettingKey>;

inline constexpr const char* kRequired = "required";
/// For keys that hold neither numbers nor words.
inline const Range kAny{};

/// The range of a key that takes one of these words.
template <typename Value>
Range one_of(const Words<Value>& words) {
  std::string list;
  for (const auto& [word, meaning] : words) list += (list.empty() ? "" : ", ") + word;
  return {list, nullptr};
}

/// A key's name in the table: step[3].moment is step.moment.
std::string without_indices(const std::string& key);

}  // namespace slipstick::solver
