#pragma once

#include <array>
#include <span>
#include <vector>

#include "solver/elasticity/law/elastic_law.hpp"
#include "solver/fft/fftw.hpp"

namespace slipstick::solver {

/// A periodic grid of even lengths. Its frequency f is xi = 2 pi f/(length h), f = 0..length/2; the symbols
/// are even or odd in f, and the last one is the Nyquist frequency.
struct PeriodicGrid {
  Index length1;
  Index length2;
  double h1;
  double h2;

  double xi1(Index f) const;
  double xi2(Index f) const;
};

/// Distinct entries of a symmetric symbol.
enum class SymbolEntry : std::size_t { p11, p12, p22 };

/// Inverses of the law's symbol at the frequencies (f1, f2), f2 those of a row. At zero frequency, where the
/// symbol of a half-space vanishes, half of the smallest frequency stands in for |xi|. p12 is zero on the
/// Nyquist frequencies, which stand for both signs of xi.
std::vector<Symbol> inverse_symbols(const PeriodicGrid& grid, const ElasticLaw& law, bool tangential,
                                    Index f1, std::span<const Index> f2);

/// Rows f1 = 0..length1/2 of the entries in use, times a factor.
class SymbolTable {
 public:
  /// Each row holds the frequencies f2 in the order in which they are given.
  SymbolTable(const PeriodicGrid& grid, const ElasticLaw& law, const std::vector<SymbolEntry>& entries,
              const std::vector<Index>& columns, double factor);

  const double* row(SymbolEntry entry, Index f1) const {
    return tables_[static_cast<std::size_t>(entry)].data() + f1 * columns_;
  }

 private:
  Index columns_;
  std::array<FftwBuffer, 3> tables_;
};

/// Means of p11 and p22 (of p11 twice for the normal kernel) over the frequencies of both signs.
std::array<double, 2> mean_inverse_symbol(const PeriodicGrid& grid, const ElasticLaw& law, bool tangential);

}  // namespace slipstick::solver
