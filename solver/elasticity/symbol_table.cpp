#include "solver/elasticity/symbol_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "solver/grid/threads.hpp"

namespace slipstick::solver {
namespace {

double frequency(Index f, Index length, double h) {
  return 2.0 * std::numbers::pi * static_cast<double>(f) / (static_cast<double>(length) * h);
}

}  // namespace

double PeriodicGrid::xi1(Index f) const { return frequency(f, length1, h1); }
double PeriodicGrid::xi2(Index f) const { return frequency(f, length2, h2); }

std::vector<Symbol> inverse_symbols(const PeriodicGrid& grid, const ElasticLaw& law, bool tangential,
                                    Index f1, std::span<const Index> f2) {
  std::vector<PlaneWave> waves;
  waves.reserve(f2.size());
  for (const Index f : f2) {
    const bool zero = f1 == 0 && f == 0;
    const double xi1 = grid.xi1(f1);
    const double xi2 = grid.xi2(f);
    waves.push_back({xi1, xi2, zero ? 0.5 * std::min(grid.xi1(1), grid.xi2(1)) : std::hypot(xi1, xi2)});
  }
  std::vector<Symbol> inverses(f2.size());
  law.inverse_symbols(tangential, grid.h1, grid.h2, waves, inverses);
  for (std::size_t i = 0; i < f2.size(); ++i) {
    const bool nyquist = 2 * f1 == grid.length1 || 2 * f2[i] == grid.length2;
    if (tangential && nyquist) inverses[i][1] = 0.0;
  }
  return inverses;
}

SymbolTable::SymbolTable(const PeriodicGrid& grid, const ElasticLaw& law,
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
      const std::vector<Symbol> inverses = inverse_symbols(grid, law, tangential, f1, columns);
      for (Index column = 0; column < columns_; ++column) {
        const Symbol& symbol = inverses[static_cast<std::size_t>(column)];
        for (const SymbolEntry entry : entries) {
          const auto e = static_cast<std::size_t>(entry);
          tables_[e].data()[f1 * columns_ + column] = factor * symbol[e];
        }
      }
    }
  });
}

std::array<double, 2> mean_inverse_symbol(const PeriodicGrid& grid, const ElasticLaw& law, bool tangential) {
  const auto signs = [](Index f, Index length) { return f == 0 || 2 * f == length ? 1.0 : 2.0; };
  const Index rows = grid.length1 / 2 + 1;
  std::vector<Index> columns(static_cast<std::size_t>(grid.length2 / 2 + 1));
  std::iota(columns.begin(), columns.end(), Index{0});
  std::vector<std::array<double, 2>> of_rows(static_cast<std::size_t>(rows));
  in_parts(ThreadPool::available(), rows, [&](int, Index first, Index last) {
    for (Index f1 = first; f1 < last; ++f1) {
      auto& sum = of_rows[static_cast<std::size_t>(f1)];
      const std::vector<Symbol> inverses = inverse_symbols(grid, law, tangential, f1, columns);
      for (const Index f2 : columns) {
        const double weight = signs(f1, grid.length1) * signs(f2, grid.length2);
        const Symbol& symbol = inverses[static_cast<std::size_t>(f2)];
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
