#include "solver/elasticity/symbol_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/grid/threads.hpp"

namespace slipstick::solver {
namespace {

double frequency(Index f, Index length, double h) {
  return 2.0 * std::numbers::pi * static_cast<double>(f) / (static_cast<double>(length) * h);
}

/// What second differences multiply a symbol by: 1 - the sum of theirs/24.
double sharpening(const PeriodicGrid& grid, const ElasticPair& pair, double xi1, double xi2) {
  if (pair.cell_traction == CellTraction::constant) return 1.0;
  const double s1 = std::sin(0.5 * xi1 * grid.h1);
  const double s2 = std::sin(0.5 * xi2 * grid.h2);
  return 1.0 + (s1 * s1 + s2 * s2) / 6.0;
}

}  // namespace

double PeriodicGrid::xi1(Index f) const { return frequency(f, length1, h1); }
double PeriodicGrid::xi2(Index f) const { return frequency(f, length2, h2); }

std::array<double, 3> inverse_symbol(const PeriodicGrid& grid, const ElasticPair& pair, bool tangential,
                                     Index f1, Index f2) {
  const bool zero = f1 == 0 && f2 == 0;
  const double xi1 = grid.xi1(f1);
  const double xi2 = grid.xi2(f2);
  const double length = zero ? 0.5 * std::min(grid.xi1(1), grid.xi2(1)) : std::hypot(xi1, xi2);
  const double modulus = length / sharpening(grid, pair, xi1, xi2);
  if (!tangential) return {modulus / pair.normal_compliance, 0.0, 0.0};
  const double transverse = modulus / pair.shear_compliance;
  if (zero) return {transverse, 0.0, transverse};
  const double n1 = xi1 / length;
  const double n2 = xi2 / length;
  const double excess =
      transverse * pair.poisson_compliance / (pair.shear_compliance - pair.poisson_compliance);
  const bool nyquist = 2 * f1 == grid.length1 || 2 * f2 == grid.length2;
  return {transverse + excess * n1 * n1, nyquist ? 0.0 : excess * n1 * n2, transverse + excess * n2 * n2};
}

SymbolTable::SymbolTable(const PeriodicGrid& grid, const ElasticPair& pair,
                         const std::vector<SymbolEntry>& entries, const std::vector<Index>& columns,
                         double factor)
    : columns_(static_cast<Index>(columns.size())) {
  const Index rows = grid.length1 / 2 + 1;
  for (const SymbolEntry entry : entries) {
    tables_[static_cast<std::size_t>(entry)] = FftwBuffer(static_cast<std::size_t>(rows * columns_));
  }
  const bool tangential = entries.size() > 1;
  in_parts(ThreadPool::available(), rows, [&](int, Index first, Index last) {
    for (Index f1 = first; f1 < last; ++f1) {
      for (Index column = 0; column < columns_; ++column) {
        const auto symbol =
            inverse_symbol(grid, pair, tangential, f1, columns[static_cast<std::size_t>(column)]);
        for (const SymbolEntry entry : entries) {
          const auto e = static_cast<std::size_t>(entry);
          tables_[e].data()[f1 * columns_ + column] = factor * symbol[e];
        }
      }
    }
  });
}

std::array<double, 2> mean_inverse_symbol(const PeriodicGrid& grid, const ElasticPair& pair,
                                          bool tangential) {
  const auto signs = [](Index f, Index length) { return f == 0 || 2 * f == length ? 1.0 : 2.0; };
  const Index rows = grid.length1 / 2 + 1;
  std::vector<std::array<double, 2>> of_rows(static_cast<std::size_t>(rows));
  in_parts(ThreadPool::available(), rows, [&](int, Index first, Index last) {
    for (Index f1 = first; f1 < last; ++f1) {
      auto& sum = of_rows[static_cast<std::size_t>(f1)];
      for (Index f2 = 0; 2 * f2 <= grid.length2; ++f2) {
        const double weight = signs(f1, grid.length1) * signs(f2, grid.length2);
        const auto symbol = inverse_symbol(grid, pair, tangential, f1, f2);
        sum[0] += weight * symbol[0];
        sum[1] += weight * symbol[tangential ? 2 : 0];
      }
    }
  });
  std::array<double, 2> sum{};
  for (const auto& row : of_rows) {
    sum[0] += row[0];
    sum[1] += row[1];
  }
  const double frequencies = static_cast<double>(grid.length1) * static_cast<double>(grid.length2);
  return {sum[0] / frequencies, sum[1] / frequencies};
}

}  // namespace slipstick::solver
