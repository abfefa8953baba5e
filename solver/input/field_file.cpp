#include "solver/input/field_file.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "solver/grid/own_rows.hpp"
#include "solver/input/datasets.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/input_file.hpp"
#include "solver/input/table_text.hpp"
#include "solver/input/whole_file.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using std::filesystem::path;

bool is_hdf5(const path& file) { return file.extension() == ".h5" || file.extension() == ".hdf5"; }

/// Heights of a map are cells of a grid. A solve on more takes tens of gigabytes.
constexpr Index kMaxHeights = Index{1} << 26;

/// Throws InputError unless all have one number a row.
void require_numbers(const path& file, const std::vector<Column>& columns, bool may_be_missing) {
  for (const Column& column : columns) {
    if (column.values.size() != columns.front().values.size()) {
      throw InputError(file.string(),
                       fmt::format("dataset {} has {} values; allowed: {}, as {}", column.name, column.values.size(),
                                   columns.front().values.size(), columns.front().name));
    }
    const auto bad = std::ranges::find_if_not(
        column.values, [&](double value) { return std::isfinite(value) || (may_be_missing && std::isnan(value)); });
    if (bad != column.values.end()) {
      throw InputError(file.string(), fmt::format("dataset {}, row {}: {}; allowed: a finite number", column.name,
                                                  bad - column.values.begin() + 1, *bad));
    }
  }
}

std::vector<Column> read_hdf5_columns(const path& file, const std::vector<std::string>& names,
                                      const std::vector<std::string>& stored) {
  const std::vector<Dataset> datasets = read_datasets(file, stored, kTableRank, kMaxRows);
  std::vector<Column> columns;
  for (std::size_t c = 0; c < names.size(); ++c) {
    const Dataset& values = datasets[c];
    if (values.size() == datasets[0].size() && values.rows() != datasets[0].rows()) {
      throw InputError(file.string(),
                       fmt::format("dataset {} has {} x {} values; allowed: {} x {}, as {}", stored[c], values.rows(),
                                   values.cols(), datasets[0].rows(), datasets[0].cols(), stored[0]));
    }
    columns.push_back({names[c], values.reshaped<Eigen::RowMajor>()});
  }
  return columns;
}

/// VTK image data as write_vti() writes it.
std::vector<Column> read_vti_columns(const path& file, const std::vector<std::string>& names,
                                     const std::vector<std::string>& stored) {
  const std::string text = read_input_file(file, kLargestTextTable, "VTK image data");
  std::vector<Column> columns;
  for (std::size_t c = 0; c < names.size(); ++c) {
    const auto at = text.find(fmt::format(" Name=\"{}\"", stored[c]));
    const auto begin = text.rfind('<', at);
    const auto end = std::min(text.find('>', at), text.size());
    if (at == std::string::npos || begin == std::string::npos ||
        text.substr(begin, end - begin).find("format=\"ascii\"") == std::string::npos) {
      throw InputError(file.string(), fmt::format("has no array {} with format=\"ascii\"; allowed: one, as --fields "
                                                  "FILE.vti writes it, or the cells as CSV",
                                                  stored[c]));
    }
    std::vector<double> values;
    const char* next = text.c_str() + std::min(end + 1, text.size());
    for (char* after = nullptr;; next = after) {
      const double value = std::strtod(next, &after);
      if (after == next || static_cast<Index>(values.size()) == kMaxRows) break;
      values.push_back(value);
    }
    next += std::strspn(next, " \t\r\n");
    if (*next != '<') {
      throw InputError(file.string(), fmt::format("array {}, value {}; allowed: a number, at most {}", stored[c],
                                                  values.size() + 1, kMaxRows));
    }
    columns.push_back({names[c], ArrayXd::Map(values.data(), static_cast<Index>(values.size()))});
  }
  return columns;
}

/// Numbers that a cell repeats, from the cell before or from another column, are put into digits once: 17,
/// which are read as the same double.
void write_csv(std::FILE* file, const Grid& grid, const std::vector<FieldColumn>& columns, const ArrayXd& keep) {
  std::vector<std::string> names;
  names.reserve(columns.size());
  for (const FieldColumn& column : columns) names.push_back(column.name);
  fmt::print(file, "{}\n", fmt::join(names, ","));
  Eigen::ArrayXXd row(grid.n2, static_cast<Index>(columns.size()));
  std::vector<std::pair<std::uint64_t, std::string>> digits(columns.size(), {0, "0"});  // of a double's bits
  std::array<char, 32> buffer;
  std::string text;
  for (Index first = 0; first < grid.cells(); first += grid.n2) {
    const Index last = first + grid.n2;
    for (std::size_t c = 0; c < columns.size(); ++c)
      columns[c].values(first, last, row.col(static_cast<Index>(c)).data());
    text.clear();
    for (Index cell = first; cell < last; ++cell) {
      if (keep[cell] == 0.0) continue;
      for (std::size_t c = 0; c < columns.size(); ++c) {
        const double value = row(cell - first, static_cast<Index>(c));
        const auto bits = std::bit_cast<std::uint64_t>(value);
        if (digits[c].first != bits) {
          const auto end = digits.begin() + static_cast<std::ptrdiff_t>(c);
          const auto same = std::find_if(digits.begin(), end, [&](const auto& d) { return d.first == bits; });
          if (same != end) {
            digits[c] = *same;
          } else {
            const auto last = std::to_chars(buffer.begin(), buffer.end(), value, std::chars_format::general, 17);
            digits[c] = {bits, std::string(buffer.data(), last.ptr)};
          }
        }
        text += digits[c].second;
        text += c + 1 < columns.size() ? ',' : '\n';
      }
    }
    fmt::print(file, "{}", text);
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

/// Each process writes the kept part of its own rows, in the order of the ranks.
void write_hdf5(const path& file, const Grid& grid, const std::vector<FieldColumn>& columns, const ArrayXd& keep) {
  const IndexRange rows = own_rows(grid);
  const Index first = rows.first * grid.n2;
  const auto own = static_cast<double>((keep.segment(first, rows.count() * grid.n2) != 0.0).count());
  const std::vector<double> kept = grid.ranks.of_each(own);
  const auto sum_to = [&](int rank) {
    return static_cast<std::size_t>(std::accumulate(kept.begin(), kept.begin() + rank, 0.0));
  };
  const std::size_t all = sum_to(grid.ranks.number());
  const std::size_t before = sum_to(grid.ranks.rank());
  std::vector<LongDataset> datasets;
  datasets.reserve(columns.size());
  for (const FieldColumn& column : columns) {
    datasets.push_back({{column.name, false, all}, before, [&](const PutBytes& put) {
                          std::vector<double> row(static_cast<std::size_t>(grid.n2));
                          for (Index start = first; start < rows.last * grid.n2; start += grid.n2) {
                            column.values(start, start + grid.n2, row.data());
                            std::size_t count = 0;
                            for (Index j = 0; j < grid.n2; ++j) {
                              if (keep[start + j] != 0.0) row[count++] = row[static_cast<std::size_t>(j)];
                            }
                            put(row.data(), count * sizeof(double));
                          }
                        }});
  }
  write_datasets(file, datasets, grid.ranks);
}

}  // namespace

std::vector<Column> read_columns(const path& file, const std::vector<std::string>& names, const TableOptions& options) {
  const bool is_vti = file.extension() == ".vti";
  if (file.extension() == ".npz" || file.extension() == ".npy") {
    throw InputError(file.string(),
                     "is NumPy's; allowed: CSV, HDF5 or .vti; in Python np.savetxt(\"field.csv\", "
                     "np.column_stack([f[k].ravel() "
                     "for k in (\"x1\", \"x2\", \"pressure\", \"q1\", \"q2\")]), delimiter=\",\", "
                     "header=\"x1,x2,pressure,q1,q2\") with f = np.load(...) makes a CSV of it");
  }
  if (!is_hdf5(file) && !is_vti) return read_text_columns(file, names, options);
  if (!options.columns.empty() && options.columns.size() != names.size()) {
    throw InputError("--columns", fmt::format("{} names; allowed: {}, the paths in the file of {}",
                                              options.columns.size(), names.size(), fmt::join(names, ", ")));
  }
  const std::vector<std::string>& stored = options.columns.empty() ? names : options.columns;
  std::vector<Column> columns = is_vti ? read_vti_columns(file, names, stored) : read_hdf5_columns(file, names, stored);
  require_numbers(file, columns, options.may_be_missing);
  return columns;
}

std::vector<Index> cells_of_rows(const path& file, const Grid& grid, const std::vector<Column>& columns) {
  constexpr double kPositionTolerance = 1e-3;  // of the cell's size
  const ArrayXd& x1 = columns[0].values;
  const ArrayXd& x2 = columns[1].values;
  const auto place = [](double x, double h, Index n) { return x / h + 0.5 * static_cast<double>(n - 1); };
  const auto is_one = [](double at, Index n) {
    return std::round(at) >= 0.0 && std::round(at) < static_cast<double>(n) &&
           std::abs(at - std::round(at)) <= kPositionTolerance;
  };
  std::vector<Index> cells;
  std::vector<bool> given(static_cast<std::size_t>(grid.cells()), false);
  for (Index row = 0; row < x1.size(); ++row) {
    const double i = place(x1[row], grid.h1, grid.n1);
    const double j = place(x2[row], grid.h2, grid.n2);
    const auto fail = [&](const std::string& complaint) {
      throw InputError(file.string(), fmt::format("row {}: ({}, {}) {}", row + 1, x1[row], x2[row], complaint));
    };
    if (!is_one(i, grid.n1) || !is_one(j, grid.n2)) {
      fail(
          "is not a cell's centre; allowed: the centres of grid.cells over grid.extent, centred at the "
          "origin");
    }
    cells.push_back(std::lround(i) * grid.n2 + std::lround(j));
    if (given[static_cast<std::size_t>(cells.back())]) {
      fail("is given a second time; allowed: one row a cell");
    }
    given[static_cast<std::size_t>(cells.back())] = true;
  }
  return cells;
}

Eigen::ArrayXXd read_matrix(const path& file, const std::string& dataset) {
  if (is_hdf5(file)) return read_datasets(file, {dataset}, 2, kMaxHeights).front();
  return read_text_matrix(file, kMaxHeights);
}

void require_field_format(const path& file, const std::string& option) {
  if (is_hdf5(file)) {
    hdf5_library(file);
  } else if (file.extension() != ".csv" && file.extension() != ".vti") {
    throw InputError(option, file.string(), file.extension().string(), ".h5, .hdf5, .csv, .vti");
  }
}

std::string fields_ending() {
  try {
    hdf5_library({});
    return ".h5";
  } catch (const InputError&) {
    return ".csv";
  }
}

void write_fields(const path& file, const Grid& grid, const std::vector<FieldColumn>& columns, const ArrayXd& keep) {
  require_field_format(file);
  if (is_hdf5(file)) {
    write_hdf5(file, grid, columns, keep);
  } else {
    if (!grid.ranks.first()) return;
    const bool is_vti = file.extension() == ".vti";
    write_whole_file(file, [&](std::FILE* stream) {
      is_vti ? write_vti(stream, grid, columns) : write_csv(stream, grid, columns, keep);
    });
  }
}

void write_fields(const path& file, const Grid& grid, const std::vector<Column>& columns, const ArrayXd& keep) {
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
