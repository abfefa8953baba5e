#pragma once

#include <array>
#include <vector>

#include "solver/elasticity/influence.hpp"
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

/// The inverse of K's symbol at one frequency, by entry; the normal kernel's is p11, with the others zero.
///
/// On the surface of a half-space, tractions of frequency xi, n = xi/|xi|, move it by (S I - N n n^T)/|xi|
/// times them along it and by C33/|xi| times them across (transforms of the solutions of Cerruti and
/// Boussinesq: 1/r becomes 2 pi/|xi|, and r_i r_j/r^3 becomes 2 pi (I - n n^T)/|xi|). The first has the
/// inverse |xi| (I + N/(S - N) n n^T)/S. At zero frequency half of the smallest frequency stands in for |xi|
/// and the term in n n^T, which has no direction there, is left out; p12 is zero on the Nyquist frequencies,
/// which stand for both signs of xi. Of smooth cell tractions it is divided by what those multiply K's by.
std::array<double, 3> inverse_symbol(const PeriodicGrid& grid, const ElasticPair& pair, bool tangential,
                                     Index f1, Index f2);

/// Rows f1 = 0..length1/2 of the entries in use, times a factor.
class SymbolTable {
 public:
  /// Each row holds the frequencies f2 in the order in which they are given.
  SymbolTable(const PeriodicGrid& grid, const ElasticPair& pair, const std::vector<SymbolEntry>& entries,
              const std::vector<Index>& columns, double factor);

  const double* row(SymbolEntry entry, Index f1) const {
    return tables_[static_cast<std::size_t>(entry)].data() + f1 * columns_;
  }

 private:
  Index columns_;
  std::array<FftwBuffer, 3> tables_;
};

/// Means of p11 and p22 (of p11 twice for the normal kernel) over the frequencies of both signs.
std::array<double, 2> mean_inverse_symbol(const PeriodicGrid& grid, const ElasticPair& pair, bool tangential);

}  // namespace slipstick::solver
