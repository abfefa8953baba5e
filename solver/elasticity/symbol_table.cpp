#include "solver/elasticity/symbol_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include "solver/grid/threads.hpp"

namespace slipstick::solver {
namespace {

double frequency(Index f, Index length, double h) {
  return 2.0 * std::numbers::pi * static_cast<double>(f) / (static_cast<double>(length) * h);
}

std::vector<Symbol> inverse_symbols(const Grid& grid, const ElasticLaw& law, bool tangential, Index f1,
                                    std::span<const Index> f2) {
  std::vector<PlaneWave> waves;
  waves.reserve(f2.size());
  const double smallest = std::min(frequency(1, grid.n1, grid.h1), frequency(1, grid.n2, grid.h2));
  for (const Index f : f2) {
    const bool zero = f1 == 0 && f == 0;
    const double xi1 = frequency(f1, grid.n1, grid.h1);
    const double xi2 = frequency(f, grid.n2, grid.h2);
    waves.push_back({xi1, xi2, zero ? 0.5 * smallest : std::hypot(xi1, xi2)});
  }
  std::vector<Symbol> inverses(f2.size());
  law.inverse_symbols(tangential, grid.h1, grid.h2, waves, inverses);
  for (std::size_t i = 0; i < f2.size(); ++i) {
    const bool nyquist = 2 * f1 == grid.n1 || 2 * f2[i] == grid.n2;
    if (tangential && nyquist) inverses[i][1] = 0.0;
  }
  return inverses;
}

}  // namespace

SymbolTable::SymbolTable(const Grid& grid, const ElasticLaw& law, std::size_t entries,
                         const std::vector<Index>& columns, double factor)
    : columns_(static_cast<Index>(columns.size())) {
  const Index rows = grid.n1 / 2 + 1;
  for (std::size_t e = 0; e < entries; ++e)
    tables_[e] = FftwBuffer(static_cast<std::size_t>(rows * columns_));
  in_parts(ThreadPool::available(), rows, [&](int, Index first, Index last) {
    for (Index f1 = first; f1 < last; ++f1) {
      const std::vector<Symbol> inverses = inverse_symbols(grid, law, entries > 1, f1, columns);
      for (std::size_t e = 0; e < entries; ++e) {
        double* const row = tables_[e].data() + f1 * columns_;
        for (std::size_t column = 0; column < columns.size(); ++column)
          row[column] = factor * inverses[column][e];
      }
    }
  });
}

std::array<double, 2> mean_inverse_symbol(const Grid& grid, const ElasticLaw& law, bool tangential) {
  const auto signs = [](Index f, Index length) { return f == 0 || 2 * f == length ? 1.0 : 2.0; };
  const Index rows = grid.n1 / 2 + 1;
  std::vector<Index> columns(static_cast<std::size_t>(grid.n2 / 2 + 1));
  std::iota(columns.begin(), columns.end(), Index{0});
  std::vector<std::array<double, 2>> of_rows(static_cast<std::size_t>(rows));
  in_parts(ThreadPool::available(), rows, [&](int, Index first, Index last) {
    for (Index f1 = first; f1 < last; ++f1) {
      auto& sum = of_rows[static_cast<std::size_t>(f1)];
      const std::vector<Symbol> inverses = inverse_symbols(grid, law, tangential, f1, columns);
      for (const Index f2 : columns) {
        const double weight = signs(f1, grid.n1) * signs(f2, grid.n2);
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
  const double frequencies = static_cast<double>(grid.n1) * static_cast<double>(grid.n2);
  return {sum[0] / frequencies, sum[1] / frequencies};
}

}  // namespace slipstick::solver
