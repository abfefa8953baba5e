#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "solver/input/setting_key.hpp"
#include "solver/input/units.hpp"

namespace slipstick::solver {

/// TOML text and the file that it comes from, which messages name; relative paths are relative to it.
struct SettingsText {
  std::string text;
  std::filesystem::path file;
};
/// Reads a file. Throws InputError where it cannot be read.
SettingsText settings_of(const std::filesystem::path& file);

/// Reads the keys of a TOML file one by one, by dotted path; an index picks one of an array of tables, as in
/// step[1].twist. The table of all keys has the allowed values; where these depend on other keys, the caller gives
/// them. The constructor reports the keys that the table does not have, reject_unknown() those that were not read.
/// Throws InputError, and std::logic_error for a key that the table does not have, unless the table is empty.
class SceneReader {
 public:
  SceneReader(const std::filesystem::path& file, const std::vector<std::string>& overrides,
              const SettingKeys& keys = {});
  SceneReader(const SettingsText& settings, const std::vector<std::string>& overrides, const SettingKeys& keys = {});

  /// Numbers without a unit are in a consistent set of units from now on: 10^length_power m, and N. A text
  /// such as "10 mm" names its own unit.
  void measure_in(int length_power);
  /// A value whose SI unit is a power of a length, in this set, by forces.
  double in_si(double value, double of_length) const;
  /// The units of the numbers that were read.
  const Units& units() const;

  /// If the command line sets one of several mutually exclusive keys, the file's other keys of that group are dropped.
  void prefer_overridden(const std::vector<std::string>& alternatives);

  bool has(const std::string& key);
  bool is_array(const std::string& key);
  bool is_text(const std::string& key);
  /// The line on which a key or a table stands; 0 where it is missing.
  std::size_t line(const std::string& key) const;
  /// Tables in the array of tables under a key; none where the key is missing.
  std::size_t count(const std::string& key);
  // The numbers that are allowed; kAny: those of the table.
  std::optional<double> find_number(const std::string& key, const Range& range = kAny);
  double number(const std::string& key, const Range& range = kAny);
  double number_or(const std::string& key, double otherwise, const Range& range = kAny);
  std::optional<std::array<double, 2>> find_pair(const std::string& key, const Range& range = kAny);
  std::array<double, 2> pair(const std::string& key, const Range& range = kAny);
  /// All numbers of a list, at least one; none where the key is missing.
  std::vector<double> numbers(const std::string& key, const Range& range = kAny);
  /// The elements of a list, at least one, as TOML writes them; none where the key is missing.
  std::vector<std::string> list(const std::string& key);
  /// The strings of a list, at least one; none where the key is missing.
  std::vector<std::string> texts(const std::string& key);
  bool flag_or(const std::string& key, bool otherwise);
  /// The content of a table as overrides: "key=value" with dotted keys, whatever they are; none where the
  /// table is missing.
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
  /// Throws one InputError that names all keys of the file that are not known, in the order of the lines.
  void refuse_unless(const std::function<bool(const std::string& key)>& is_known) const;
  std::string why_unknown(const std::string& key) const;
  [[noreturn]] void fail_choice(const std::string& key, const std::string& word,
                                const std::vector<std::string>& allowed) const;
  /// The range, or the table's where it is kAny.
  const Range& range_for(const std::string& key, const Range& range) const;
  void apply_override(const std::string& assignment);
  std::string where(const std::string& key) const;

  std::filesystem::path file_;
  struct ReadKeys;  ///< the parsed file, the table of keys, and the keys read so far
  std::shared_ptr<ReadKeys> toml_;
  std::set<std::string> overridden_;
};

}  // namespace slipstick::solver
