#pragma once

#include <array>

#include "solver/elasticity/inverse_symbol.hpp"
#include "solver/elasticity/symbol_table.hpp"
#include "solver/fft/periodic_transform.hpp"

namespace slipstick::solver {

/// cos and sin of pi k1/(2 t1), and of pi k2/(2 t2) for some k2.
struct Twiddles {
  double c;
  double s;
  const double* c2;
  const double* s2;
};

/// The inverse symbol on a quadrant: the periodic one of the mirrored field, whose period is 2 t1 x 2 t2
/// cells, by cosine and sine transforms of the quadrant, padded with zeros to t1 x t2 cells.
///
/// 1. Samples are reordered in each direction: the even ones forwards, then the odd ones backwards. A cosine
///    transform is the Fourier transform of these times a twiddle factor (Makhoul, IEEE Transactions on
///    Acoustics, Speech and Signal Processing 28, 1980); a sine transform is the cosine transform of samples
///    with alternating signs, with t - k for the frequency k.
/// 2. PeriodicTransform: rows, then columns, in batches of kColumns.
/// 3. separate(): the coefficients at k1 and t1 - k1 by k2 and t2 - k2 follow from the Fourier transform at
///    (k1, k2) and (t1 - k1, k2).
/// 4. multiply(): the coefficients times the inverse symbol.
/// 5. join(), columns and rows backward, the order of the samples restored.
class MirroredInverseSymbol final : public InverseSymbol {
 public:
  /// With options.diagonal only the first component is transformed; the second is minus its transpose.
  MirroredInverseSymbol(const Grid& grid, bool tangential, const ElasticLaw& law,
                        const OperatorOptions& options);

  void apply(std::span<double> field) override;
  std::array<double, 2> diagonal() const override { return diagonal_; }

 private:
  using Columns = PeriodicTransform::Columns;
  static constexpr Index kColumns = PeriodicTransform::kColumns;

  /// Coefficients of reordered samples in some columns, by cosines (c) of the frequency k or sines (s), which
  /// are the cosines of t - k, along x1 and x2.
  struct Coefficients {
    using Values = std::array<double, static_cast<std::size_t>(kColumns)>;
    Values cc, cs, sc, ss;
  };

  void fill_twiddles();
  /// Factors of the samples at even and at odd places of row i.
  std::array<double, 2> signs(Index f, Index i) const;
  void load(int thread, Index f, Index i, const double* values);
  void store(int thread, Index f, Index i, double* values);
  Twiddles twiddles(Index k1, Index first_column) const;
  // In some columns. count: their number, known to the compiler where they fill a cache line.
  template <typename Count>
  void separate(const Columns& columns, Count count, Index f, Index k1, Coefficients& to) const;
  template <typename Count>
  void join(const Coefficients& from, const Columns& columns, Count count, Index f, Index k1) const;
  template <typename Count>
  void multiply(const Columns& columns, Count count) const;
  template <typename Count>
  void multiply_rows(std::array<Coefficients, 2>& x, const Columns& columns, Count count, Index k1) const;
  // For a mirror at the diagonal: forward into spectrum_, and back from there.
  template <typename Count>
  void keep_spectrum(const Columns& columns, Count count);
  template <typename Count>
  void multiply_spectrum(const Columns& columns, Count count) const;
  const double* spectrum(Index k1) const { return spectrum_.data() + k1 * transform_.row_stride(); }
  void store_transposed(double* field, Index first_row, Index last_row) const;

  Grid grid_;
  bool tangential_;
  bool symmetric_;
  Index t1_;
  Index t2_;
  Index half_;  ///< t2/2 + 1
  std::array<double, 2> diagonal_;
  IndexRange columns_;  ///< of this rank, of 0..t2/2
  SymbolTable table_;   ///< those frequencies, then t2 less each of them
  PeriodicTransform transform_;
  FftwBuffer spectrum_;  ///< symmetric fields only: t1 rows, frequencies k2, then t2 - k2
  FftwBuffer twiddles_;  ///< cos and sin of pi k/(2 t1), k = 0..t1/2, then of pi k/(2 t2)
};

}  // namespace slipstick::solver
