#include "solver/input/table_text.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>
#include <ranges>
#include <tuple>
#include <utility>

#include "solver/input/datasets.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/input_file.hpp"
#include "solver/input/units.hpp"

namespace slipstick::solver {
namespace {

using std::filesystem::path;

/// Values on a line, at most: a grid has no more cells along a side.
constexpr std::size_t kMaxColumns = 65536;
/// Bytes that comments and the line of names take, at most, where only the names are read.
constexpr std::uintmax_t kLongestHeader = 1 << 20;
/// Some programs begin a text with it.
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::string_view kBlanks = " \t\r";
/// The first that fits holds: a comma may be a decimal mark, a blank may be for the eye.
constexpr std::array kSeparators{';', '\t', ',', ' '};
constexpr std::string_view kSeparatorsInWords =
    "commas, semicolons, tabs or blanks between columns; no commas between them where they are decimal marks";

std::string_view trimmed(std::string_view text) {
  const auto is_around = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '"'; };
  while (!text.empty() && is_around(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_around(text.back())) text.remove_suffix(1);
  return text;
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

/// "x1 [mm]" or "x1 (mm)" is x1 in mm.
struct Heading {
  std::string_view name;
  std::string_view unit;
};

Heading heading_of(std::string_view text) {
  const auto open = text.find_first_of("[(");
  if (open == std::string_view::npos || open == 0 || (text.back() != ']' && text.back() != ')')) return {text, ""};
  return {trimmed(text.substr(0, open)), trimmed(text.substr(open + 1, text.size() - open - 2))};
}

/// The text of a table, line by line. Lines without anything are skipped.
class TextTable {
 public:
  explicit TextTable(const path& file, std::uintmax_t most = UINTMAX_MAX)
      : file_(file),
        text_(read_input_file(file, kLargestTextTable,
                              "a table as text (CSV), VTK image data named .vti, or an HDF5 file named .h5 or .hdf5",
                              most)) {
    if (text_.starts_with(kByteOrderMark)) next_ = kByteOrderMark.size();
  }

  /// The first line that is no comment, or a comment before it that has all the names.
  std::vector<Heading> header(const std::vector<std::string>& names) {
    std::vector<Heading> found;
    for (std::string_view line = next_line(); !line.empty(); line = next_line()) {
      const bool comment = is_comment(line);
      found = headings(comment ? line.substr(std::min(line.find_first_not_of("#% \t"), line.size())) : line);
      const auto has = [&](const std::string& name) { return !places(found, name).empty(); };
      if (!names.empty() && std::ranges::all_of(names, has)) break;
      if (!comment) break;
      found.clear();
    }
    return found;
  }

  /// Where the caller gives the names, a header line before the rows is skipped.
  void skip_header() {
    const auto [next, line] = std::pair(next_, line_);
    std::string_view first = next_line();
    while (is_comment(first)) first = next_line();
    if (has_number(headings(first))) std::tie(next_, line_) = std::pair(next, line);
  }

  static bool has_number(const std::vector<Heading>& headings) {
    return std::ranges::any_of(headings, [](const Heading& heading) {
      return !heading.name.empty() && std::string_view("+-.0123456789").find(heading.name[0]) != std::string_view::npos;
    });
  }

  /// Where a name stands: as the header writes it, or, where nothing does, in other cases.
  static std::vector<std::size_t> places(const std::vector<Heading>& header, const std::string& name) {
    std::vector<std::size_t> exact;
    std::vector<std::size_t> other;
    for (std::size_t i = 0; i < header.size(); ++i) {
      if (header[i].name == name) exact.push_back(i);
      if (lower_case(header[i].name) == lower_case(name)) other.push_back(i);
    }
    return exact.empty() ? other : exact;
  }

  /// The values of the next row as text; none at the end. They stay until the next call. The first row
  /// decides on the separator, which must give this number of columns and numbers in the columns `read`.
  const std::vector<std::string_view>& next_row(std::size_t columns, const std::vector<std::size_t>& read) {
    values_.clear();
    std::string_view line = next_line();
    while (is_comment(line)) line = next_line();
    if (line.empty()) return values_;
    line = line.substr(0, std::min(line.find(" #"), line.size()));
    if (!separator_) {
      const auto fits = [&](char separator) {
        split(line, separator, columns);
        return values_.size() == columns && std::ranges::all_of(read, [&](std::size_t column) {
                 return values_[column].empty() || parse_number(values_[column], 0);
               });
      };
      const auto found = std::ranges::find_if(kSeparators, fits);
      separator_ = columns > 0 && found != kSeparators.end() ? *found : likely_separator(line);
    }
    split(line, *separator_, columns);
    return values_;
  }

  /// In SI units. NaN for one that is missing, where that may be.
  double number(std::string_view text, int power, bool may_be_missing) {
    if (may_be_missing && text.empty()) return std::numeric_limits<double>::quiet_NaN();
    const bool comma = text.find(',') != std::string_view::npos;
    const bool point = text.find('.') != std::string_view::npos;
    if (comma || point) {
      if ((comma && point) || (has_mark_ && comma_ != comma)) {
        fail(
            fmt::format("\"{}\": decimal commas and points in one table; allowed: one of them, and no "
                        "thousands separator",
                        shown(text)));
      }
      has_mark_ = true;
      comma_ = comma;
    }
    const std::optional<double> value = parse_number(text, power);
    if (!value || !(std::isfinite(*value) || (may_be_missing && std::isnan(*value)))) {
      fail(fmt::format("\"{}\"; allowed: a finite number", shown(text)));
    }
    return *value;
  }

  [[noreturn]] void fail(const std::string& complaint) const {
    throw InputError(fmt::format("{}:{}", file_.string(), line_), complaint);
  }

 private:
  static bool is_comment(std::string_view line) {
    const auto first = line.find_first_not_of(kBlanks);
    return first != std::string_view::npos && (line[first] == '#' || line[first] == '%');
  }

  static char likely_separator(std::string_view line) {
    return *std::ranges::find_if(kSeparators, [&](char separator) {
      return separator == ' ' || trimmed(line).find(separator) != std::string_view::npos;
    });
  }

  /// Empty at the end.
  std::string_view next_line() {
    while (next_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', next_), text_.size());
      const std::string_view line = std::string_view(text_).substr(next_, end - next_);
      next_ = end + 1;
      ++line_;
      if (line.find_first_not_of(kBlanks) != std::string_view::npos) return line;
    }
    return {};
  }

  std::vector<Heading> headings(std::string_view line) {
    split(line, likely_separator(line), 0);
    std::vector<Heading> found;
    for (const std::string_view text : values_) found.push_back(heading_of(text));
    return found;
  }

  /// Empty values after the last column are ignored. A run of blanks is one separator; a unit belongs to the
  /// name before it.
  void split(std::string_view line, char separator, std::size_t columns) {
    values_.clear();
    const auto add = [&](std::string_view value) {
      if (values_.size() == kMaxColumns) fail(fmt::format("more than {} values", kMaxColumns));
      values_.push_back(trimmed(value));
    };
    for (std::size_t first = 0; first <= line.size();) {
      std::size_t end = 0;
      if (separator != ' ') {
        end = std::min(line.find(separator, first), line.size());
        add(line.substr(first, end - first));
      } else {
        first = line.find_first_not_of(kBlanks, first);
        if (first == std::string_view::npos) break;
        const bool unit = !values_.empty() && (line[first] == '[' || line[first] == '(');
        end = std::min(line.find_first_of(unit ? "])" : kBlanks, first), line.size());
        if (!unit) {
          add(line.substr(first, end - first));
        } else {
          const char* const begin = values_.back().data();
          end = std::min(end + 1, line.size());
          values_.back() = {begin, static_cast<std::size_t>(line.data() + end - begin)};
        }
      }
      first = end + 1;
    }
    while (values_.size() > std::max<std::size_t>(columns, 1) && values_.back().empty()) values_.pop_back();
  }

  const path& file_;
  std::string text_;
  std::size_t next_ = 0;
  std::size_t line_ = 0;
  std::optional<char> separator_;
  bool has_mark_ = false;
  bool comma_ = false;
  std::vector<std::string_view> values_;
};

int power_of(const path& file, const Heading& heading) {
  if (heading.unit.empty()) return 0;
  const Unit* const unit = find_unit(heading.unit);
  if (unit == nullptr) {
    throw InputError(file.string(),
                     fmt::format("column {}: unit {}; allowed: {}", shown(heading.name), shown(heading.unit),
                                 fmt::join(kUnits | std::views::transform(&Unit::word), ", ")));
  }
  return unit->power;
}

/// The place of a name in a header.
std::size_t find_column(const path& file, const std::string& name, const std::vector<Heading>& header) {
  const std::vector<std::size_t> found = TextTable::places(header, name);
  if (found.size() > 1) throw InputError(file.string(), fmt::format("has two columns {}; allowed: one", name));
  if (found.size() == 1) return found[0];
  if (TextTable::has_number(header)) {
    throw InputError(file.string(),
                     "has no header; allowed: a first line with the columns' names, as "
                     "x1,x2,pressure,q1,q2; for check, --columns with these names does as well");
  }
  std::vector<std::string_view> there;
  for (const Heading& heading : header) there.push_back(heading.name);
  throw InputError(file.string(),
                   fmt::format("has no column {}; its columns: {}", name,
                               there.empty() ? "none, it is empty" : shown(fmt::format("{}", fmt::join(there, ", ")))));
}

}  // namespace

std::vector<std::string> text_table_names(const path& file) {
  TextTable table(file, kLongestHeader);
  std::vector<std::string> names;
  for (const Heading& heading : table.header({})) names.push_back(lower_case(heading.name));
  return names;
}

std::vector<Column> read_text_columns(const path& file, const std::vector<std::string>& names,
                                      const TableOptions& options) {
  TextTable table(file);
  std::vector<Heading> header;
  for (const std::string& name : options.columns) header.push_back(heading_of(name));
  header.empty() ? void(header = table.header(names)) : table.skip_header();
  std::vector<std::size_t> places;
  std::vector<int> powers;
  for (const std::string& name : names) {
    places.push_back(find_column(file, name, header));
    powers.push_back(power_of(file, header[places.back()]));
  }
  std::vector<std::vector<double>> values(names.size());
  for (;;) {
    const std::vector<std::string_view>& row = table.next_row(header.size(), places);
    if (row.empty()) break;
    if (row.size() != header.size()) {
      table.fail(
          fmt::format("{} values; allowed: {}, one a column ({})", row.size(), header.size(), kSeparatorsInWords));
    }
    if (static_cast<Index>(values[0].size()) == kMaxRows) table.fail(fmt::format("more than {} rows", kMaxRows));
    for (std::size_t c = 0; c < names.size(); ++c) {
      values[c].push_back(table.number(row[places[c]], powers[c], options.may_be_missing));
    }
  }
  if (values[0].empty()) throw InputError(file.string(), "holds no rows of numbers");
  std::vector<Column> columns;
  for (std::size_t c = 0; c < names.size(); ++c) {
    columns.push_back({names[c], Eigen::ArrayXd::Map(values[c].data(), static_cast<Index>(values[c].size()))});
  }
  return columns;
}

Eigen::ArrayXXd read_text_matrix(const path& file, Index max_values) {
  TextTable table(file);
  std::vector<double> values;
  std::size_t columns = 0;
  for (;;) {
    const std::vector<std::string_view>& row = table.next_row(columns, {});
    if (row.empty()) break;
    if (values.empty()) columns = row.size();
    if (row.size() != columns) {
      table.fail(fmt::format("{} values; allowed: {}, as in the rows before", row.size(), columns));
    }
    if (static_cast<Index>(values.size() + columns) > max_values)
      table.fail(fmt::format("more than {} values", max_values));
    for (const std::string_view text : row) values.push_back(table.number(text, 0, true));
  }
  if (values.empty()) throw InputError(file.string(), "holds no rows of numbers");
  return Eigen::Map<const Dataset>(values.data(), static_cast<Index>(values.size() / columns),
                                   static_cast<Index>(columns));
}

}  // namespace slipstick::solver
