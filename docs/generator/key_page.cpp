#include "docs/generator/key_page.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "convergence/results/markup.hpp"

namespace slipstick::docs {
namespace {

using solver::KeyType;
using solver::SettingKey;
using solver::SettingKeys;

std::string type_text(KeyType type) {
  switch (type) {
    case KeyType::number:
      return "number";
    case KeyType::pair:
      return "[a, b], two numbers";
    case KeyType::numbers:
      return "[a, b, ...], numbers";
    case KeyType::word:
      return "one of some words";
    case KeyType::text:
      return "text";
    case KeyType::texts:
      return "[\"a\", \"b\", ...], texts";
    case KeyType::file:
      return "path, relative to this file";
    case KeyType::flag:
      return "true or false";
    case KeyType::values:
      return "[a, b, ...], values";
    case KeyType::table:
      return "table, { \"key\" = value }";
    case KeyType::tables:
      return "tables";
  }
  throw std::logic_error("a type of keys without a text");
}

/// The dotted name of the table that a key stands in; empty at the top.
std::string table_of(const std::string& key) {
  const auto dot = key.rfind('.');
  return dot == std::string::npos ? "" : key.substr(0, dot);
}

/// A table's heading, with two brackets if the table may occur several times.
std::string heading(const std::string& table, const SettingKeys& keys) {
  if (table.empty()) return "Above all tables";
  const bool several = table == "upper.shape" || std::ranges::any_of(keys, [&](const SettingKey& key) {
                         return key.name == table && key.type == KeyType::tables;
                       });
  return several ? fmt::format("[[{}]]", table) : fmt::format("[{}]", table);
}

std::string last_part(const std::string& key) { return key.substr(key.rfind('.') + 1); }

std::string row(const SettingKey& key) {
  const std::string words = key.type == KeyType::flag ? "true, false" : key.allowed.words;
  const std::string shapes =
      key.shapes.empty() ? "" : fmt::format(" For `{}`.", fmt::join(key.shapes, "`, `"));
  return fmt::format("| `{}` | {} | {} | {} | {} | {}{} |\n", last_part(key.name), type_text(key.type),
                     key.unit, key.otherwise, words, convergence::markdown_cell(key.meaning), shapes);
}

std::vector<std::string> rows_of(const std::string& table, const SettingKeys& keys) {
  std::vector<std::string> rows;
  for (const SettingKey& key : keys) {
    if (table_of(key.name) == table) rows.push_back(row(key));
  }
  return rows;
}

/// A table's keys, or a reference to the first table before it that has all of them.
std::string table_text(const std::string& table, const std::vector<std::string>& before,
                       const SettingKeys& keys) {
  const std::vector<std::string> rows = rows_of(table, keys);
  for (const std::string& other : before) {
    const std::vector<std::string> known = rows_of(other, keys);
    const auto stands_there = [&](const std::string& one) {
      return std::ranges::find(known, one) != known.end();
    };
    if (!std::ranges::all_of(rows, stands_there)) continue;
    std::vector<std::string> names;
    for (const SettingKey& key : keys) {
      if (table_of(key.name) == table) names.push_back(last_part(key.name));
    }
    return fmt::format("The same keys as in {}: `{}`.\n", heading(other, keys), fmt::join(names, "`, `"));
  }
  return fmt::format("| key | type | unit | default | allowed | meaning |\n|---|---|---|---|---|---|\n{}",
                     fmt::join(rows, ""));
}

}  // namespace

std::string keys_markdown(const PageHead& head, const SettingKeys& keys) {
  std::vector<std::string> tables;
  for (const SettingKey& key : keys) {
    const std::string table = table_of(key.name);
    if (std::ranges::find(tables, table) == tables.end()) tables.push_back(table);
  }
  std::string page = fmt::format(
      "# {}\n\n{}\n\nWritten by `make reference` from the table of the program's reader; a "
      "test "
      "fails if this page\ndiffers from it. An unknown key is an error that names the nearest known "
      "one.\n",
      head.title, head.text);
  for (auto table = tables.begin(); table != tables.end(); ++table) {
    page += fmt::format("\n## {}\n\n{}", heading(*table, keys),
                        table_text(*table, {tables.begin(), table}, keys));
  }
  return page;
}

}  // namespace slipstick::docs
