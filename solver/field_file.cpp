#include "solver/field_file.hpp"

#include <fmt/core.h>
#include <fmt/os.h>
#include <fmt/ranges.h>
#include <hdf5.h>
#include <hdf5_hl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <utility>

#include "solver/input_error.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using std::filesystem::path;

bool is_hdf5(const path& file) { return file.extension() == ".h5" || file.extension() == ".hdf5"; }

/// An open HDF5 file; the library's own messages stay off the terminal.
class Hdf5File {
 public:
  enum class Mode { read, create };
  Hdf5File(const path& file, Mode mode) : file_(file) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    id_ = mode == Mode::read ? H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)
                             : H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    if (id_ < 0)
      throw InputError(file.string(), mode == Mode::read ? "cannot be read as HDF5" : "cannot be written");
  }
  ~Hdf5File() { H5Fclose(id_); }
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  void write(const std::string& name, const ArrayXd& values) {
    const auto size = static_cast<hsize_t>(values.size());
    require(H5LTmake_dataset_double(id_, name.c_str(), 1, &size, values.data()) >= 0, name,
            "cannot be written");
  }

  /// A dataset of one or two dimensions, as rows x columns with rows of one another in memory.
  Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> read(const std::string& name,
                                                                             int rank) {
    int found_rank = 0;
    require(H5LTfind_dataset(id_, name.c_str()) == 1 &&
                H5LTget_dataset_ndims(id_, name.c_str(), &found_rank) >= 0,
            name, "no such dataset");
    require(found_rank == rank, name, fmt::format("has {} dimensions; allowed: {}", found_rank, rank));
    std::array<hsize_t, 2> size{1, 1};
    require(H5LTget_dataset_info(id_, name.c_str(), size.data(), nullptr, nullptr) >= 0, name,
            "cannot be read");
    Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values(static_cast<Index>(size[0]),
                                                                                 static_cast<Index>(size[1]));
    require(H5LTread_dataset_double(id_, name.c_str(), values.data()) >= 0, name,
            "cannot be read as numbers");
    return values;
  }

 private:
  void require(bool good, const std::string& name, const std::string& complaint) const {
    if (!good) throw InputError(fmt::format("{}: dataset {}", file_.string(), name), complaint);
  }
  path file_;
  hid_t id_ = -1;
};

std::ifstream open_text(const path& file) {
  std::ifstream stream(file);
  if (!stream || std::filesystem::is_directory(file)) throw InputError(file.string(), "cannot be read");
  return stream;
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> parts;
  std::istringstream stream(line);
  for (std::string part; std::getline(stream, part, ',');) {
    const auto first = part.find_first_not_of(" \t\r\"");
    const auto last = part.find_last_not_of(" \t\r\"");
    parts.push_back(first == std::string::npos ? "" : part.substr(first, last - first + 1));
  }
  return parts;
}

double parse_number(const std::string& text, const path& file, std::size_t line) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value)) {
    throw InputError(fmt::format("{}:{}", file.string(), line),
                     fmt::format("\"{}\"; allowed: a finite number", text));
  }
  return value;
}

/// NaN for one that is missing.
double parse_height(const std::string& text, const path& file, std::size_t line) {
  const bool missing = text.empty() || text == "nan" || text == "NaN" || text == "NAN";
  return missing ? std::numeric_limits<double>::quiet_NaN() : parse_number(text, file, line);
}

/// Rows of numbers, all of one length, from line `first_line` on; empty lines are skipped.
template <typename Parse>
std::vector<std::vector<double>> read_rows(std::ifstream& stream, const path& file, std::size_t first_line,
                                           const Parse& parse) {
  std::vector<std::vector<double>> rows;
  std::size_t line_number = first_line;
  for (std::string line; std::getline(stream, line); ++line_number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    std::vector<double> row;
    for (const std::string& part : split(line)) row.push_back(parse(part, file, line_number));
    if (!rows.empty() && row.size() != rows.front().size()) {
      throw InputError(
          fmt::format("{}:{}", file.string(), line_number),
          fmt::format("{} values; allowed: {}, as in the rows before", row.size(), rows.front().size()));
    }
    rows.push_back(std::move(row));
  }
  if (rows.empty()) throw InputError(file.string(), "holds no rows of numbers");
  return rows;
}

std::vector<Column> read_csv_columns(const path& file, const std::vector<std::string>& names) {
  std::ifstream stream = open_text(file);
  std::string line;
  std::getline(stream, line);
  const std::vector<std::string> header = split(line);
  std::vector<std::size_t> positions;
  for (const std::string& name : names) {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found == header.end()) {
      throw InputError(file.string(),
                       fmt::format("has no column {}; its columns: {}", name, fmt::join(header, ", ")));
    }
    positions.push_back(static_cast<std::size_t>(found - header.begin()));
  }
  const auto rows = read_rows(stream, file, 2, parse_number);
  if (rows.front().size() != header.size()) {
    throw InputError(fmt::format("{}:2", file.string()),
                     fmt::format("{} values; allowed: {}, one a column", rows.front().size(), header.size()));
  }
  std::vector<Column> columns;
  for (std::size_t c = 0; c < names.size(); ++c) {
    ArrayXd values(static_cast<Index>(rows.size()));
    for (std::size_t r = 0; r < rows.size(); ++r) values[static_cast<Index>(r)] = rows[r][positions[c]];
    columns.push_back({names[c], std::move(values)});
  }
  return columns;
}

std::vector<Column> read_hdf5_columns(const path& file, const std::vector<std::string>& names) {
  Hdf5File hdf5(file, Hdf5File::Mode::read);
  std::vector<Column> columns;
  for (const std::string& name : names) {
    columns.push_back({name, hdf5.read(name, 1).col(0)});
    const ArrayXd& values = columns.back().values;
    if (values.size() != columns.front().values.size()) {
      throw InputError(file.string(),
                       fmt::format("dataset {} has {} values; allowed: {}, as {}", name, values.size(),
                                   columns.front().values.size(), names.front()));
    }
    for (Index row = 0; row < values.size(); ++row) {
      if (!std::isfinite(values[row])) {
        throw InputError(file.string(), fmt::format("dataset {}, row {}: {}; allowed: a finite number", name,
                                                    row, values[row]));
      }
    }
  }
  return columns;
}

void write_csv(const path& file, const std::vector<Column>& columns) {
  std::ofstream stream(file);
  std::vector<std::string> names;
  names.reserve(columns.size());
  for (const Column& column : columns) names.push_back(column.name);
  stream << fmt::format("{}\n", fmt::join(names, ","));
  for (Index row = 0; row < columns.front().values.size(); ++row) {
    const char* separator = "";
    for (const Column& column : columns) {
      stream << fmt::format("{}{:.17g}", std::exchange(separator, ","), column.values[row]);
    }
    stream << '\n';
  }
  if (!stream.flush()) throw InputError(file.string(), "cannot be written");
}

/// VTK's x runs fastest, this project's x2 does.
void write_vti(const path& file, const Grid& grid, const std::vector<Column>& columns) {
  std::ofstream stream(file);
  stream
      << "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      << fmt::format(
             "<ImageData WholeExtent=\"0 {0} 0 {1} 0 0\" Origin=\"{2:.17g} {3:.17g} 0\" "
             "Spacing=\"{4:.17g} {5:.17g} 1\">\n<Piece Extent=\"0 {0} 0 {1} 0 0\">\n<CellData>\n",
             grid.n1, grid.n2, grid.x1(0) - 0.5 * grid.h1, grid.x2(0) - 0.5 * grid.h2, grid.h1, grid.h2);
  for (const Column& column : columns) {
    stream << fmt::format("<DataArray type=\"Float64\" Name=\"{}\" format=\"ascii\">\n", column.name);
    for (Index j = 0; j < grid.n2; ++j) {
      for (Index i = 0; i < grid.n1; ++i) stream << fmt::format("{:.17g} ", column.values[i * grid.n2 + j]);
      stream << '\n';
    }
    stream << "</DataArray>\n";
  }
  stream << "</CellData>\n</Piece>\n</ImageData>\n</VTKFile>\n";
  if (!stream.flush()) throw InputError(file.string(), "cannot be written");
}

std::vector<Column> kept_rows(const std::vector<Column>& columns, const ArrayXd& keep) {
  std::vector<Index> rows;
  for (Index i = 0; i < keep.size(); ++i) {
    if (keep[i] != 0.0) rows.push_back(i);
  }
  std::vector<Column> kept;
  kept.reserve(columns.size());
  for (const Column& column : columns) kept.push_back({column.name, column.values(rows)});
  return kept;
}

}  // namespace

std::vector<Column> read_columns(const path& file, const std::vector<std::string>& names) {
  return is_hdf5(file) ? read_hdf5_columns(file, names) : read_csv_columns(file, names);
}

Eigen::ArrayXXd read_height_map(const path& file) {
  if (is_hdf5(file)) return Hdf5File(file, Hdf5File::Mode::read).read("height", 2);
  std::ifstream stream = open_text(file);
  const auto rows = read_rows(stream, file, 1, parse_height);
  Eigen::ArrayXXd heights(static_cast<Index>(rows.size()), static_cast<Index>(rows.front().size()));
  for (Index i = 0; i < heights.rows(); ++i) {
    for (Index j = 0; j < heights.cols(); ++j) {
      heights(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    }
  }
  return heights;
}

void require_field_format(const path& file) {
  if (!is_hdf5(file) && file.extension() != ".csv" && file.extension() != ".vti") {
    throw InputError("--fields", file.string(), file.extension().string(), ".h5, .hdf5, .csv, .vti");
  }
}

void write_fields(const path& file, const Grid& grid, const std::vector<Column>& columns,
                  const ArrayXd& keep) {
  require_field_format(file);
  if (file.extension() == ".vti") {
    write_vti(file, grid, columns);
  } else if (is_hdf5(file)) {
    Hdf5File hdf5(file, Hdf5File::Mode::create);
    for (const Column& column : kept_rows(columns, keep)) hdf5.write(column.name, column.values);
  } else {
    write_csv(file, kept_rows(columns, keep));
  }
}

}  // namespace slipstick::solver
