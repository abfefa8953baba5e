#include "solver/input/toml_reader.hpp"

#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <map>
#include <ranges>
#include <sstream>

#include "solver/input/input_error.hpp"
#include "solver/input/input_file.hpp"
#include "solver/input/long_key.hpp"
#include "solver/input/misspelling.hpp"

namespace slipstick::solver {
namespace {

/// Unknown keys that one message lists, at most.
constexpr std::size_t kMostListed = 20;
const std::string kLongKey = fmt::format("a key of more than {0} parts; allowed: {0}", kMaxKeyParts);

toml::table parse(const std::string& text, const std::string& file) {
  if (text.find('\0') != std::string::npos) {
    throw InputError(file, "is a binary file; allowed: a TOML file");
  }
  if (const auto line = line_of_long_key(text)) throw InputError(fmt::format("{}:{}", file, line), kLongKey);
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}:{}", file, error.source().begin.line), std::string(error.description()));
  }
}

/// A value as a scene has it: numbers with the fewest digits that read back the same.
std::string print(const toml::node& node) {
  if (const auto* const number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* const array = node.as_array()) {
    std::vector<std::string> parts;
    for (const toml::node& part : *array) parts.push_back(print(part));
    return fmt::format("[{}]", fmt::join(parts, ", "));
  }
  std::ostringstream text;
  text << toml::node_view<const toml::node>(node);
  return text.str();
}

/// The node's number, or none. Integers of more than 53 bits are rounded to double.
std::optional<double> number_of(const toml::node& node) {
  if (const auto* const whole = node.as_integer()) return static_cast<double>(whole->get());
  if (const auto* const number = node.as_floating_point()) return number->get();
  return std::nullopt;
}

/// Powers of a length in an SI unit: the other parts of the unit are forces.
constexpr std::pair<std::string_view, int> kLengthPowers[]{{"m", 1}, {"Pa", -2}, {"N m", 1}, {"m/Pa", 3}};

/// The allowed numbers; after a text such as .5 or 5., which shells and C accept, also how TOML writes it.
std::string with_point(const toml::node& node, const std::string& allowed) {
  const std::string text = fmt::format(" {} ", node.value_or(std::string()));
  const auto is_digit = [&](std::size_t at) { return text[at] >= '0' && text[at] <= '9'; };
  for (std::size_t at = 1; (at = text.find('.', at)) != std::string::npos; ++at) {
    if (is_digit(at - 1) != is_digit(at + 1)) return allowed + "; TOML has a digit on both sides of a point, 0.5";
  }
  return allowed;
}

bool is_array_of_tables(const toml::node& node) { return node.is_array() && node.is_homogeneous<toml::table>(); }

/// A value of a table, and its dotted path.
struct Leaf {
  std::string key;
  const toml::node* value;
};

/// Collects all leaves of a table. into_arrays: also the leaves of tables in arrays; otherwise such an array is a leaf.
void collect_leaves(const toml::table& table, const std::string& prefix, bool into_arrays, std::vector<Leaf>& leaves) {
  for (const auto& [name, child] : table) {
    const std::string key = prefix + std::string(name.str());
    if (const toml::table* const inner = child.as_table()) {
      collect_leaves(*inner, key + ".", into_arrays, leaves);
    } else if (into_arrays && is_array_of_tables(child)) {
      const toml::array& tables = *child.as_array();
      for (std::size_t i = 0; i < tables.size(); ++i) {
        collect_leaves(*tables[i].as_table(), fmt::format("{}[{}].", key, i), true, leaves);
      }
    } else {
      leaves.push_back({key, &child});
    }
  }
}

/// The table that one part of a dotted path names, "name" or "name[index]": one without an index is made
/// where it is missing. Null where something else stands there, or nothing.
toml::table* table_below(toml::table& table, const std::string& part) {
  if (part.ends_with(']')) return table.at_path(part).as_table();
  return table.insert(part, toml::table{}).first->second.as_table();
}

}  // namespace

SettingsText settings_of(const std::filesystem::path& file) {
  return {.text = read_input_file(file, kLargestSettings, "a TOML file"), .file = file};
}

struct SceneReader::ReadKeys {
  toml::table root;
  std::map<std::string, SettingKey> keys;
  std::set<std::string> read;
  Units units;
  int length_power = 0;  ///< numbers without a unit are in a set of units whose length is 10^length_power m

  /// A value in SI: of a number, or of a text with a unit where the key has one; none for others.
  std::optional<double> number(const toml::node& node, const std::string& key) {
    const auto found = keys.find(without_indices(key));
    const std::string unit = found == keys.end() ? "" : found->second.unit;
    if (const auto* const text = node.as_string()) return units.read(text->get(), unit);
    const auto value = number_of(node);
    const auto* const power = std::ranges::find(kLengthPowers, unit, &std::pair<std::string_view, int>::first);
    if (!value || length_power == 0 || power == std::end(kLengthPowers)) return value;
    return parse_number(fmt::format("{}", *value), length_power * power->second);
  }
  /// What a number's key allows, with its units and with a hint at TOML's form.
  std::string for_number(const toml::node& node, const std::string& key, const std::string& allowed) const {
    const auto found = keys.find(without_indices(key));
    const std::string words = found == keys.end() ? "" : Units::list(found->second.unit);
    const bool has_units = node.is_string() && !words.empty();
    return with_point(node, has_units ? fmt::format("{}; or a text with a unit, {}", allowed, words) : allowed);
  }

  const SettingKey& setting(const std::string& key) const {
    const auto found = keys.find(without_indices(key));
    if (found == keys.end()) throw std::logic_error(fmt::format("the table of keys has no {}", key));
    return found->second;
  }
  /// Null where the key is missing.
  const toml::node* node(const std::string& key) {
    if (!keys.empty()) setting(key);
    read.insert(key);
    return root.at_path(key).node();
  }
  bool has_below(const std::string& name) const {
    const auto from = keys.lower_bound(name + ".");
    return from != keys.end() && from->first.starts_with(name + ".");
  }
  /// Whether the table of keys has a key, a table of this name, or a key whose value holds it.
  bool allows(const std::string& key) const {
    const std::string name = without_indices(key);
    if (has_below(name) || keys.contains(name)) return true;
    for (std::size_t end = name.find('.'); end != std::string::npos; end = name.find('.', end + 1)) {
      const std::string above = name.substr(0, end);
      if (keys.contains(above) && !has_below(above)) return true;
    }
    return false;
  }
  /// All keys and the tables in which they are, or, without a table of keys, those that were read.
  std::vector<std::string> names() const {
    std::set<std::string> names;
    for (const std::string& key : read) names.insert(without_indices(key));
    for (const auto& [name, key] : keys) {
      for (std::size_t end = name.find('.'); end != std::string::npos; end = name.find('.', end + 1))
        names.insert(name.substr(0, end));
      names.insert(name);
    }
    return {names.begin(), names.end()};
  }
};

SceneReader::SceneReader(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                         const SettingKeys& keys)
    : SceneReader(settings_of(file), overrides, keys) {}

SceneReader::SceneReader(const SettingsText& settings, const std::vector<std::string>& overrides,
                         const SettingKeys& keys)
    : file_(settings.file),
      toml_(new ReadKeys{
          .root = parse(settings.text, settings.file.string()), .keys = {}, .read = {}, .units = Units()}) {
  for (const SettingKey& key : keys) toml_->keys.emplace(key.name, key);
  for (const std::string& assignment : overrides) apply_override(assignment);
  if (!keys.empty()) refuse_unless([this](const std::string& key) { return toml_->allows(key); });
}

void SceneReader::apply_override(const std::string& assignment) {
  const std::string source = fmt::format("--set {}", assignment);
  const auto equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) throw InputError(source, "allowed: key=value");
  const std::string key = assignment.substr(0, equals);
  const std::string value = assignment.substr(equals + 1);
  const std::string settings = fmt::format("value = {}", value);
  if (line_of_long_key(settings) != 0) throw InputError(source, kLongKey);
  toml::table parsed;
  try {
    parsed = toml::parse(settings);
  } catch (const toml::parse_error&) {  // a bare word is a string
    parsed = toml::table{{"value", value}};
  }
  toml::table* table = &toml_->root;
  std::istringstream path(key);
  std::string part;
  std::vector<std::string> parts;
  while (std::getline(path, part, '.')) parts.push_back(part);
  if (parts.empty() || parts.size() > kMaxKeyParts) {
    throw InputError(source, fmt::format("allowed: a key of 1 to {} parts", kMaxKeyParts));
  }
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    table = table_below(*table, parts[i]);
    if (table == nullptr) {
      throw InputError(source,
                       fmt::format("{} is not a table{}", parts[i],
                                   parts[i].ends_with(']') ? " of the scene file, where they are counted from 0" : ""));
    }
  }
  table->insert_or_assign(parts.back(), *parsed.get("value"));
  overridden_.insert(key);
}

void SceneReader::prefer_overridden(const std::vector<std::string>& alternatives) {
  const auto overridden = [&](const std::string& key) { return overridden_.contains(key); };
  if (std::none_of(alternatives.begin(), alternatives.end(), overridden)) return;
  for (const std::string& key : alternatives) {
    if (overridden(key) || !toml_->root.at_path(key)) continue;
    const auto dot = key.rfind('.');
    toml_->root.at_path(key.substr(0, dot)).as_table()->erase(key.substr(dot + 1));
  }
}

const Range& SceneReader::range_for(const std::string& key, const Range& range) const {
  return range.contains ? range : toml_->setting(key).allowed;
}

std::string SceneReader::where(const std::string& key) const {
  const auto is_set = [&](const std::string& set) { return key == set || key.starts_with(set + "."); };
  if (std::ranges::any_of(overridden_, is_set)) return "--set";
  const auto node = toml_->root.at_path(key);
  return node ? fmt::format("{}:{}", file_.string(), node.node()->source().begin.line) : file_.string();
}

void SceneReader::fail(const std::string& key, const std::string& value, const std::string& allowed) const {
  throw InputError(where(key), key, value, allowed);
}

void SceneReader::fail_missing(const std::string& key, const std::string& allowed) const {
  const std::string parent = key.substr(0, key.rfind('.'));
  const auto found = toml_->root.at_path(parent);
  if (found && !found.is_table()) fail(parent, print(*found.node()), fmt::format("a table with the key {}", key));
  fail(key, "(missing)", allowed);
}

std::string SceneReader::why_unknown(const std::string& key) const {
  const auto found = toml_->keys.find(without_indices(key));
  if (found == toml_->keys.end()) return "unknown key; " + nearest_key(key, toml_->names());
  const SettingKey& setting = found->second;
  return setting.shapes.empty()
             ? "unknown key with these values; its meaning: " + setting.meaning
             : fmt::format("unknown key of this shape; it belongs to {}", fmt::join(setting.shapes, ", "));
}

void SceneReader::refuse_unless(const std::function<bool(const std::string& key)>& is_known) const {
  std::vector<Leaf> unknown;
  collect_leaves(toml_->root, "", true, unknown);
  std::erase_if(unknown, [&](const Leaf& leaf) { return is_known(leaf.key); });
  if (unknown.empty()) return;
  std::ranges::stable_sort(unknown, {}, [](const Leaf& leaf) { return leaf.value->source().begin.line; });
  std::vector<std::string> complaints;
  for (const Leaf& leaf : unknown | std::views::take(kMostListed)) {
    const std::string place = complaints.empty() ? "" : where(leaf.key) + ": ";
    complaints.push_back(
        fmt::format("{}{} = {}: {}", place, leaf.key, print(*leaf.value).substr(0, kMaxShown), why_unknown(leaf.key)));
  }
  if (unknown.size() > kMostListed)
    complaints.push_back(fmt::format("and {} more unknown keys", unknown.size() - kMostListed));
  throw InputError(where(unknown.front().key), fmt::format("{}", fmt::join(complaints, "\n  ")));
}

void SceneReader::fail_choice(const std::string& key, const std::string& word,
                              const std::vector<std::string>& allowed) const {
  fail(key, fmt::format("\"{}\"", word), fmt::format("{}", fmt::join(allowed, ", ")));
}

void SceneReader::measure_in(int length_power) {
  toml_->length_power = length_power;
  if (length_power == 0) return;
  for (const auto& [si, power] : kLengthPowers) {
    const auto* const unit = std::ranges::find_if(
        kUnits, [&](const Unit& each) { return each.si == si && each.power == length_power * power; });
    if (unit != kUnits.end()) toml_->units.use(si, unit->word);
  }
}

double SceneReader::in_si(double value, double of_length) const {
  return value * std::pow(10.0, toml_->length_power * of_length);
}

const Units& SceneReader::units() const { return toml_->units; }

bool SceneReader::has(const std::string& key) { return toml_->node(key) != nullptr; }

bool SceneReader::is_array(const std::string& key) { return has(key) && toml_->node(key)->is_array(); }

bool SceneReader::is_text(const std::string& key) { return has(key) && toml_->node(key)->is_string(); }

std::size_t SceneReader::line(const std::string& key) const {
  const auto found = toml_->root.at_path(key);
  return found ? found.node()->source().begin.line : 0;
}

std::size_t SceneReader::count(const std::string& key) {
  const auto* const found = toml_->node(key);
  if (found == nullptr) return 0;
  if (!is_array_of_tables(*found)) fail(key, print(*found), fmt::format("tables, each headed [[{}]]", key));
  return found->as_array()->size();
}

std::optional<double> SceneReader::find_number(const std::string& key, const Range& range) {
  const Range& allowed = range_for(key, range);
  const auto* const found = toml_->node(key);
  if (found == nullptr) return std::nullopt;
  const auto value = toml_->number(*found, key);
  if (!value) fail(key, print(*found), toml_->for_number(*found, key, fmt::format("a number, {}", allowed.words)));
  if (!allowed.contains(*value)) fail(key, print(*found), allowed.words);
  return value;
}

double SceneReader::number(const std::string& key, const Range& range) {
  const auto value = find_number(key, range);
  if (!value) fail_missing(key, fmt::format("a number, {}", range_for(key, range).words));
  return *value;
}

double SceneReader::number_or(const std::string& key, double otherwise, const Range& range) {
  return find_number(key, range).value_or(otherwise);
}

std::optional<std::array<double, 2>> SceneReader::find_pair(const std::string& key, const Range& range) {
  const Range& each = range_for(key, range);
  const auto* const found = toml_->node(key);
  if (found == nullptr) return std::nullopt;
  const toml::array* const array = found->as_array();
  const std::string allowed = fmt::format("[a, b], two numbers, each {}", each.words);
  if (array == nullptr || array->size() != 2) fail(key, print(*found), with_point(*found, allowed));
  std::array<double, 2> pair{};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto value = toml_->number((*array)[i], key);
    if (!value || !each.contains(*value)) fail(key, print(*found), allowed);
    pair[i] = *value;
  }
  return pair;
}

std::array<double, 2> SceneReader::pair(const std::string& key, const Range& range) {
  const auto value = find_pair(key, range);
  if (!value) fail_missing(key, fmt::format("[a, b], two numbers, each {}", range_for(key, range).words));
  return *value;
}

std::vector<double> SceneReader::numbers(const std::string& key, const Range& range) {
  std::vector<double> values;
  const std::size_t count = list(key).size();
  for (std::size_t i = 0; i < count; ++i) values.push_back(number(fmt::format("{}[{}]", key, i), range));
  return values;
}

std::vector<std::string> SceneReader::list(const std::string& key) {
  const auto* const found = toml_->node(key);
  if (found == nullptr) return {};
  const toml::array* const array = found->as_array();
  if (array == nullptr || array->empty()) fail(key, print(*found), "a list, [a, b, ...], of at least one");
  std::vector<std::string> elements;
  for (const toml::node& element : *array) elements.push_back(print(element));
  return elements;
}

std::vector<std::string> SceneReader::texts(const std::string& key) {
  const char* allowed = "a list of strings, [\"a\", \"b\", ...], of at least one";
  const auto* const found = toml_->node(key);
  if (found == nullptr) return {};
  const toml::array* const array = found->as_array();
  if (array == nullptr || array->empty()) fail(key, print(*found), allowed);
  std::vector<std::string> texts;
  for (const toml::node& element : *array) {
    if (!element.is_string()) fail(key, print(element), allowed);
    texts.push_back(*element.value<std::string>());
  }
  return texts;
}

bool SceneReader::flag_or(const std::string& key, bool otherwise) {
  const auto* const found = toml_->node(key);
  if (found == nullptr) return otherwise;
  if (!found->is_boolean()) fail(key, print(*found), "true, false");
  return *found->value<bool>();
}

std::vector<std::string> SceneReader::assignments(const std::string& key) {
  const auto* const found = toml_->node(key);
  if (found == nullptr) return {};
  if (!found->is_table()) fail(key, print(*found), "a table, { \"key\" = value }");
  std::vector<Leaf> leaves;
  collect_leaves(*found->as_table(), key + ".", true, leaves);
  for (const Leaf& leaf : leaves) toml_->read.insert(leaf.key);
  leaves.clear();
  collect_leaves(*found->as_table(), "", false, leaves);
  std::vector<std::string> assignments;
  for (const Leaf& leaf : leaves) assignments.push_back(fmt::format("{}={}", leaf.key, print(*leaf.value)));
  return assignments;
}

std::string SceneReader::text(const std::string& key) {
  const auto* const found = toml_->node(key);
  if (found == nullptr) fail_missing(key, "a string");
  if (!found->is_string()) fail(key, print(*found), "a string");
  return *found->value<std::string>();
}

std::string SceneReader::text_or(const std::string& key, const std::string& otherwise) {
  return has(key) ? text(key) : otherwise;
}

std::filesystem::path SceneReader::path(const std::string& key) { return file_.parent_path() / text(key); }

void SceneReader::reject_unknown() const {
  refuse_unless([this](const std::string& key) { return toml_->read.contains(key); });
}

}  // namespace slipstick::solver
