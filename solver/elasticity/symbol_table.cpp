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

/// Inverse symbols of one row of frequencies after the other, in memory of its own.
class SymbolRow {
 public:
  SymbolRow(const Grid& grid, const ElasticLaw& law, bool tangential, std::span<const Index> f2)
      : grid_(grid), law_(law), tangential_(tangential), f2_(f2), waves_(f2.size()), inverses_(f2.size()) {}

  std::span<const Symbol> at(Index f1) {
    const double smallest = std::min(frequency(1, grid_.n1, grid_.h1), frequency(1, grid_.n2, grid_.h2));
    const double xi1 = frequency(f1, grid_.n1, grid_.h1);
    for (std::size_t i = 0; i < f2_.size(); ++i) {
      const double xi2 = frequency(f2_[i], grid_.n2, grid_.h2);
      const bool zero = f1 == 0 && f2_[i] == 0;
      waves_[i] = {xi1, xi2, zero ? 0.5 * smallest : std::hypot(xi1, xi2)};
    }
    law_.inverse_symbols(tangential_, grid_.h1, grid_.h2, waves_, inverses_);
    for (std::size_t i = 0; i < f2_.size(); ++i) {
      const bool nyquist = 2 * f1 == grid_.n1 || 2 * f2_[i] == grid_.n2;
      if (tangential_ && nyquist) inverses_[i][1] = 0.0;
    }
    return inverses_;
  }

 private:
  const Grid& grid_;
  const ElasticLaw& law_;
  bool tangential_;
  std::span<const Index> f2_;
  std::vector<PlaneWave> waves_;
  std::vector<Symbol> inverses_;
};

}  // namespace

SymbolTable::SymbolTable(const Grid& grid, const ElasticLaw& law, std::size_t entries,
                         const std::vector<Index>& columns, double factor)
    : columns_(static_cast<Index>(columns.size())) {
  const Index rows = grid.n1 / 2 + 1;
  for (std::size_t e = 0; e < entries; ++e) tables_[e] = FftwBuffer(static_cast<std::size_t>(rows * columns_));
  in_parts(ThreadPool::available(), rows, [&](int, Index first, Index last) {
    SymbolRow symbols(grid, law, entries > 1, columns);
    for (Index f1 = first; f1 < last; ++f1) {
      const std::span<const Symbol> inverses = symbols.at(f1);
      for (std::size_t e = 0; e < entries; ++e) {
        double* const row = tables_[e].data() + f1 * columns_;
        for (std::size_t column = 0; column < columns.size(); ++column) row[column] = factor * inverses[column][e];
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
    SymbolRow symbols(grid, law, tangential, columns);
    for (Index f1 = first; f1 < last; ++f1) {
      auto& sum = of_rows[static_cast<std::size_t>(f1)];
      const std::span<const Symbol> inverses = symbols.at(f1);
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
