#pragma once

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace slipstick::analytic::testing {

/// One row of a reference table, by column.
class Row {
 public:
  Row(const std::vector<std::string>& columns, const std::string& line) : line_(line) {
    std::istringstream cells(line);
    std::string cell;
    for (const auto& column : columns)
      if (std::getline(cells, cell, ',')) cells_[column] = cell;
  }
  const std::string& text(const std::string& column) const { return cells_.at(column); }
  /// Beyond double precision, so that the reference's own rounding does not count as an error.
  long double number(const std::string& column) const { return std::strtold(text(column).c_str(), nullptr); }
  double argument(const std::string& column) const { return std::strtod(text(column).c_str(), nullptr); }
  const std::string& line() const { return line_; }

 private:
  std::string line_;
  std::map<std::string, std::string> cells_;
};

/// The rows of a CSV file with a comment line and the column names above them.
inline std::vector<Row> read_rows(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  std::getline(file, line);
  std::vector<std::string> columns;
  std::istringstream header(line);
  for (std::string column; std::getline(header, column, ',');) columns.push_back(column);
  std::vector<Row> rows;
  while (std::getline(file, line)) rows.emplace_back(columns, line);
  if (rows.empty()) throw std::runtime_error("no reference rows in " + path);
  return rows;
}

/// A table of this folder.
inline std::vector<Row> read_references(const std::string& name) {
  return read_rows(std::string(SLIPSTICK_REFERENCES) + "/" + name);
}

/// |value / reference - 1|; a NaN stays one.
inline double relative_error(double value, long double reference) {
  const long double error = (static_cast<long double>(value) - reference) / reference;
  return static_cast<double>(error < 0 ? -error : error);
}

}  // namespace slipstick::analytic::testing
