#include "solver/input/field_file.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "solver/grid/ranks.hpp"
#include "solver/input/dataset_reader.hpp"
#include "solver/input/dataset_writer.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/input_file.hpp"
#include "solver/input/whole_file.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using std::filesystem::path;

bool is_hdf5(const path& file) { return file.extension() == ".h5" || file.extension() == ".hdf5"; }

/// Rows of a table are cells of a contact, of 4,096 x 4,096 at most; heights of a map are cells of a grid. A
/// solve on more takes tens of gigabytes.
constexpr Index kMaxRows = Index{1} << 24;
constexpr Index kMaxHeights = Index{1} << 26;
/// Values on a line: as many as a grid has cells along a side.
constexpr std::size_t kMaxColumns = 65536;
/// Written by some programs at the beginning of a text.
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kAround = " \t\r\"";
  const auto first = text.find_first_not_of(kAround);
  return first == std::string_view::npos ? std::string_view()
                                         : text.substr(first, text.find_last_not_of(kAround) - first + 1);
}

/// The text of a CSV file, line by line. Lines without anything are skipped.
class CsvFile {
 public:
  explicit CsvFile(const path& file)
      : file_(file),
        text_(read_input_file(file, kLargestTable, "a CSV file, or an HDF5 file named .h5 or .hdf5")) {
    if (text_.starts_with(kByteOrderMark)) next_ = kByteOrderMark.size();
  }

  /// The values of the next line as text; none at the end. They stay until the next call.
  const std::vector<std::string_view>& next_line() {
    values_.clear();
    while (values_.empty() && next_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', next_), text_.size());
      const std::string_view line = std::string_view(text_).substr(next_, end - next_);
      next_ = end + 1;
      ++line_;
      split(line);
    }
    return values_;
  }

  double number(std::string_view text) const {
    // The text ends with a separator or, after the last, with a zero: where strtod stops.
    char* end = nullptr;
    const double value = text.empty() ? NAN : std::strtod(text.data(), &end);
    if (end != text.data() + text.size() || !std::isfinite(value)) {
      fail(fmt::format("\"{}\"; allowed: a finite number", shown(text)));
    }
    return value;
  }

  /// NaN for one that is missing.
  double height(std::string_view text) const {
    const bool missing = text.empty() || text == "nan" || text == "NaN" || text == "NAN";
    return missing ? std::numeric_limits<double>::quiet_NaN() : number(text);
  }

  [[noreturn]] void fail(const std::string& complaint) const {
    throw InputError(fmt::format("{}:{}", file_.string(), line_), complaint);
  }

 private:
  /// A separator at the end of the line is followed by nothing.
  void split(std::string_view line) {
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) return;
    for (std::size_t first = 0; first < line.size();) {
      if (values_.size() == kMaxColumns) fail(fmt::format("more than {} values", kMaxColumns));
      const std::size_t comma = std::min(line.find(',', first), line.size());
      values_.push_back(trimmed(line.substr(first, comma - first)));
      first = comma + 1;
    }
  }

  const path& file_;
  std::string text_;
  std::size_t next_ = 0;
  std::size_t line_ = 0;
  std::vector<std::string_view> values_;
};

/// The place of each name in a header.
std::vector<std::size_t> find_columns(const path& file, const std::vector<std::string>& names,
                                      const std::vector<std::string_view>& header) {
  std::vector<std::size_t> positions;
  for (const std::string& name : names) {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found == header.end()) {
      throw InputError(file.string(),
                       fmt::format("has no column {}; its columns: {}", name,
                                   header.empty() ? "none, it is empty"
                                                  : shown(fmt::format("{}", fmt::join(header, ", ")))));
    }
    if (std::find(found + 1, header.end(), name) != header.end()) {
      throw InputError(file.string(), fmt::format("has two columns {}; allowed: one", name));
    }
    positions.push_back(static_cast<std::size_t>(found - header.begin()));
  }
  return positions;
}

std::vector<Column> read_csv_columns(const path& file, const std::vector<std::string>& names) {
  CsvFile csv(file);
  const std::vector<std::string_view> header = csv.next_line();
  const std::vector<std::size_t> positions = find_columns(file, names, header);
  std::vector<std::vector<double>> values(names.size());
  for (;;) {
    const std::vector<std::string_view>& row = csv.next_line();
    if (row.empty()) break;
    if (row.size() != header.size()) {
      csv.fail(fmt::format("{} values; allowed: {}, one a column", row.size(), header.size()));
    }
    if (static_cast<Index>(values[0].size()) == kMaxRows)
      csv.fail(fmt::format("more than {} rows", kMaxRows));
    for (std::size_t c = 0; c < names.size(); ++c) values[c].push_back(csv.number(row[positions[c]]));
  }
  if (values[0].empty()) throw InputError(file.string(), "holds no rows of numbers");
  std::vector<Column> columns;
  for (std::size_t c = 0; c < names.size(); ++c) {
    columns.push_back({names[c], ArrayXd::Map(values[c].data(), static_cast<Index>(values[c].size()))});
  }
  return columns;
}

std::vector<Column> read_hdf5_columns(const path& file, const std::vector<std::string>& names) {
  const std::vector<Dataset> datasets = read_datasets(file, names, 1, kMaxRows);
  std::vector<Column> columns;
  for (std::size_t c = 0; c < names.size(); ++c) {
    const std::string& name = names[c];
    columns.push_back({name, datasets[c].col(0)});
    const ArrayXd& values = columns.back().values;
    if (values.size() != columns.front().values.size()) {
      throw InputError(file.string(),
                       fmt::format("dataset {} has {} values; allowed: {}, as {}", name, values.size(),
                                   columns.front().values.size(), names.front()));
    }
    const auto bad = std::ranges::find_if_not(values, [](double value) { return std::isfinite(value); });
    if (bad != values.end()) {
      throw InputError(file.string(), fmt::format("dataset {}, row {}: {}; allowed: a finite number", name,
                                                  bad - values.begin(), *bad));
    }
  }
  return columns;
}

void write_csv(std::FILE* file, const Grid& grid, const std::vector<FieldColumn>& columns,
               const ArrayXd& keep) {
  std::vector<std::string> names;
  names.reserve(columns.size());
  for (const FieldColumn& column : columns) names.push_back(column.name);
  fmt::print(file, "{}\n", fmt::join(names, ","));
  Eigen::ArrayXXd row(grid.n2, static_cast<Index>(columns.size()));
  for (Index first = 0; first < grid.cells(); first += grid.n2) {
    const Index last = first + grid.n2;
    for (std::size_t c = 0; c < columns.size(); ++c)
      columns[c].values(first, last, row.col(static_cast<Index>(c)).data());
    for (Index cell = first; cell < last; ++cell) {
      if (keep[cell] == 0.0) continue;
      const char* separator = "";
      for (const double value : row.row(cell - first))
        fmt::print(file, "{}{:.17g}", std::exchange(separator, ","), value);
      fmt::print(file, "\n");
    }
  }
}

/// VTK's x runs fastest, this project's x2 does.
void write_vti(std::FILE* file, const Grid& grid, const std::vector<FieldColumn>& columns) {
  fmt::print(file,
             "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"0.1\" "
             "byte_order=\"LittleEndian\">\n"
             "<ImageData WholeExtent=\"0 {0} 0 {1} 0 0\" Origin=\"{2:.17g} {3:.17g} 0\" "
             "Spacing=\"{4:.17g} {5:.17g} 1\">\n<Piece Extent=\"0 {0} 0 {1} 0 0\">\n<CellData>\n",
             grid.n1, grid.n2, grid.x1(0) - 0.5 * grid.h1, grid.x2(0) - 0.5 * grid.h2, grid.h1, grid.h2);
  ArrayXd values(grid.cells());
  for (const FieldColumn& column : columns) {
    column.values(0, grid.cells(), values.data());
    fmt::print(file, "<DataArray type=\"Float64\" Name=\"{}\" format=\"ascii\">\n", column.name);
    for (Index j = 0; j < grid.n2; ++j) {
      for (Index i = 0; i < grid.n1; ++i) fmt::print(file, "{:.17g} ", values[i * grid.n2 + j]);
      fmt::print(file, "\n");
    }
    fmt::print(file, "</DataArray>\n");
  }
  fmt::print(file, "</CellData>\n</Piece>\n</ImageData>\n</VTKFile>\n");
}

/// Each rank has what is kept of its own rows, after that of the ranks before it.
void write_hdf5(const path& file, const Grid& grid, const std::vector<FieldColumn>& columns,
                const ArrayXd& keep) {
  const Share rows = RowBands(grid.n1).own_rows();
  const Index first = rows.first * grid.n2;
  const auto own = static_cast<double>((keep.segment(first, rows.count() * grid.n2) != 0.0).count());
  const std::vector<double> kept = Ranks::of_each(own);
  const auto own_at = kept.begin() + Ranks::rank();
  std::vector<LongDataset> datasets;
  datasets.reserve(columns.size());
  for (const FieldColumn& column : columns) {
    datasets.push_back({column.name, static_cast<Index>(std::accumulate(kept.begin(), kept.end(), 0.0)),
                        static_cast<Index>(std::accumulate(kept.begin(), own_at, 0.0)),
                        [&](const LongDataset::Put& put) {
                          std::vector<double> row(static_cast<std::size_t>(grid.n2));
                          for (Index i = rows.first; i < rows.last; ++i) {
                            const Index start = i * grid.n2;
                            column.values(start, start + grid.n2, row.data());
                            std::size_t count = 0;
                            for (Index j = 0; j < grid.n2; ++j) {
                              if (keep[start + j] != 0.0) row[count++] = row[static_cast<std::size_t>(j)];
                            }
                            put(std::span(row).first(count));
                          }
                        }});
  }
  write_datasets(file, datasets);
}

}  // namespace

std::vector<Column> read_columns(const path& file, const std::vector<std::string>& names) {
  return is_hdf5(file) ? read_hdf5_columns(file, names) : read_csv_columns(file, names);
}

Eigen::ArrayXXd read_height_map(const path& file) {
  if (is_hdf5(file)) return read_datasets(file, {"height"}, 2, kMaxHeights).front();
  CsvFile csv(file);
  std::vector<double> heights;
  std::size_t columns = 0;
  for (;;) {
    const std::vector<std::string_view>& row = csv.next_line();
    if (row.empty()) break;
    if (heights.empty()) columns = row.size();
    if (row.size() != columns) {
      csv.fail(fmt::format("{} values; allowed: {}, as in the rows before", row.size(), columns));
    }
    if (static_cast<Index>(heights.size() + columns) > kMaxHeights)
      csv.fail(fmt::format("more than {} values", kMaxHeights));
    for (const std::string_view text : row) heights.push_back(csv.height(text));
  }
  if (heights.empty()) throw InputError(file.string(), "holds no rows of numbers");
  return Eigen::Map<const Dataset>(heights.data(), static_cast<Index>(heights.size() / columns),
                                   static_cast<Index>(columns));
}

void require_field_format(const path& file) {
  if (!is_hdf5(file) && file.extension() != ".csv" && file.extension() != ".vti") {
    throw InputError("--fields", file.string(), file.extension().string(), ".h5, .hdf5, .csv, .vti");
  }
}

void write_fields(const path& file, const Grid& grid, const std::vector<FieldColumn>& columns,
                  const ArrayXd& keep) {
  require_field_format(file);
  if (is_hdf5(file)) {
    write_hdf5(file, grid, columns, keep);
  } else {
    if (!Ranks::first()) return;
    const bool is_vti = file.extension() == ".vti";
    write_whole_file(file, [&](std::FILE* stream) {
      is_vti ? write_vti(stream, grid, columns) : write_csv(stream, grid, columns, keep);
    });
  }
}

void write_fields(const path& file, const Grid& grid, const std::vector<Column>& columns,
                  const ArrayXd& keep) {
  std::vector<FieldColumn> from_kept;
  from_kept.reserve(columns.size());
  for (const Column& column : columns) {
    from_kept.push_back({column.name, [&values = column.values](Index first, Index last, double* out) {
                           std::copy(values.data() + first, values.data() + last, out);
                         }});
  }
  write_fields(file, grid, from_kept, keep);
}

}  // namespace slipstick::solver
