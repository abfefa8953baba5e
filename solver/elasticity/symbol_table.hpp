#pragma once

#include <array>
#include <vector>

#include "solver/elasticity/law/elastic_law.hpp"
#include "solver/fft/fftw.hpp"

namespace slipstick::solver {

/// Distinct entries of a symmetric symbol.
enum class SymbolEntry : std::size_t { p11, p12, p22 };

/// Inverses of a law's symbol on a periodic grid of even lengths, times a factor: rows f1 = 0..n1/2 of the
/// entries in use, with xi = 2 pi f/(n h). The symbols are even or odd in f; the last frequency is Nyquist's.
/// At zero frequency, where the inverse symbol of a half-space vanishes, |xi| is half of the smallest
/// frequency. p12 is zero at Nyquist's frequency, where xi has both signs.
class SymbolTable {
 public:
  /// entries: 1, p11 of the normal kernel; 2 or 3, the first of them of the tangential one. Each row holds
  /// the frequencies f2 in the order in which they are given.
  SymbolTable(const Grid& grid, const ElasticLaw& law, std::size_t entries, const std::vector<Index>& columns,
              double factor);

  const double* row(SymbolEntry entry, Index f1) const {
    return tables_[static_cast<std::size_t>(entry)].data() + f1 * columns_;
  }

 private:
  Index columns_;
  std::array<FftwBuffer, 3> tables_;
};

/// Means of p11 and p22 (of p11 twice for the normal kernel) over the frequencies of both signs.
std::array<double, 2> mean_inverse_symbol(const Grid& grid, const ElasticLaw& law, bool tangential);

}  // namespace slipstick::solver
