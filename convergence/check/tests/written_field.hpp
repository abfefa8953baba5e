#pragma once

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "solver/input/field_file.hpp"
#include "solver/solve.hpp"

/// Fields as other programs write them.
namespace slipstick::convergence {

/// x1, x2, pressure, q1, q2.
using FieldRow = std::array<double, 5>;
using FieldRows = std::vector<FieldRow>;

inline std::filesystem::path temporary_file(const std::string& name) {
  return std::filesystem::path(testing::TempDir()) / name;
}

inline std::filesystem::path write_rows(const FieldRows& rows, int digits = 17,
                                        const std::string& name = "field.csv") {
  const std::filesystem::path file = temporary_file(name);
  std::ofstream stream(file);
  stream << "x1,x2,pressure,q1,q2\n";
  for (const auto& [x1, x2, p, q1, q2] : rows) {
    stream << fmt::format("{0:.{5}e},{1:.{5}e},{2:.{5}e},{3:.{5}e},{4:.{5}e}\n", x1, x2, p, q1, q2,
                          digits - 1);
  }
  return file;
}

/// The contact cells of a solution.
inline FieldRows rows_of(const solver::Solution& solution) {
  const solver::Index cells = solution.grid.cells();
  const Eigen::ArrayXd x1 = solver::cell_x1(solution.grid);
  const Eigen::ArrayXd x2 = solver::cell_x2(solution.grid);
  const Eigen::ArrayXd& p = solution.pressure;
  const Eigen::ArrayXd& q = solution.traction;
  FieldRows rows;
  for (solver::Index i = 0; i < cells; ++i) {
    if (p[i] > 0.0) rows.push_back({x1[i], x2[i], p[i], q[i], q[i + cells]});
  }
  return rows;
}

inline FieldRows read_rows(const std::filesystem::path& file) {
  const auto columns = solver::read_columns(file, {"x1", "x2", "pressure", "q1", "q2"});
  FieldRows rows(static_cast<std::size_t>(columns[0].values.size()));
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (std::size_t c = 0; c < 5; ++c) rows[row][c] = columns[c].values[static_cast<solver::Index>(row)];
  }
  return rows;
}

template <typename Change>
FieldRows changed(FieldRows rows, const Change& change) {
  for (FieldRow& row : rows) change(row);
  return rows;
}

inline FieldRows shuffled(FieldRows rows) {
  std::ranges::shuffle(rows, std::mt19937(1));
  return rows;
}

}  // namespace slipstick::convergence
