#pragma once

#include <array>

#include "solver/elasticity/inverse_symbol.hpp"
#include "solver/elasticity/symbol_table.hpp"
#include "solver/fft/plane_transform.hpp"

namespace slipstick::solver {

/// cos and sin of pi k1/(2 t1), and those of pi k2/(2 t2) for some k2.
struct Twiddles {
  double c;
  double s;
  const double* c2;
  const double* s2;
};

/// The inverse symbol on a quadrant: the periodic one on the mirrored field, whose period is 2 t1 x 2 t2
/// cells, by cosine and sine transforms of the quadrant alone, padded with zeros to t1 x t2 cells.
///
/// A cosine transform is a Fourier transform of the same length, of the even samples forwards and then the
/// odd ones backwards, times a twiddle factor (Makhoul, IEEE Transactions on Acoustics, Speech and Signal
/// Processing 28, 1980); in two dimensions so along each. Coefficients of the frequencies k1 and t1 - k1 by
/// k2 and t2 - k2 follow from the Fourier transform at (k1, k2) and (t1 - k1, k2) and from nothing else. A
/// sine transform is a cosine transform of samples with alternating signs, t - k instead of its frequency k:
/// the same four, in another order. So two rows of the transform at a time are turned into coefficients,
/// multiplied and turned back.
class MirroredInverseSymbol final : public InverseSymbol {
 public:
  /// With options.diagonal the first component alone is transformed. The second is minus its transpose.
  MirroredInverseSymbol(const Grid& grid, bool tangential, const ElasticLaw& law,
                        const OperatorOptions& options);

  void apply(std::span<double> field) override;
  std::array<double, 2> diagonal() const override { return diagonal_; }

 private:
  /// half_ values each, k2 = 0..t2/2, of the transform of reordered samples along x1 and x2: by cosines (c)
  /// of the frequency k or sines (s), which are the cosines of t - k.
  struct Coefficients {
    double* cc;
    double* cs;
    double* sc;
    double* ss;
  };

  /// A thread's memory: coefficients of each field, and after them a row that is thrown away.
  double* scratch(int thread) { return coefficients_.data() + thread * scratch_; }
  Coefficients coefficients(int thread, Index f);
  void fill_twiddles();
  /// By which samples at even and odd places of row i are to be multiplied.
  std::array<double, 2> signs(Index f, Index i) const;
  void load(int thread, Index f, Index i, const double* values);
  void store(int thread, Index f, Index i, double* values);
  Twiddles twiddles(Index k1, Index first_column) const;
  /// In some columns. count: their number, known to the compiler where they are whole cache lines.
  template <typename Count>
  void separate(int thread, const PlaneColumns& columns, Count count, Index f, Index k1);
  template <typename Count>
  void join(int thread, const Coefficients& from, const PlaneColumns& columns, Count count, Index f,
            Index k1);
  /// work(thread, k1) for the rows k1 = 0..t1/2, each for itself and for row t1 - k1.
  template <typename Work>
  void for_row_pairs(const Work& work);
  template <typename Count>
  void multiply(int thread, const PlaneColumns& columns, Count count);
  template <typename Count>
  void multiply_rows(int thread, const PlaneColumns& columns, Count count, Index k1);
  void multiply_symmetric();
  void multiply_symmetric_rows(int thread, Index k1);
  void store_transposed(double* field, Index first_row, Index last_row) const;

  Grid grid_;
  bool tangential_;
  bool symmetric_;
  Index t1_;
  Index t2_;
  Index half_;  ///< t2/2 + 1
  std::array<double, 2> diagonal_;
  IndexRange columns_;  ///< of this rank, of 0..t2/2
  SymbolTable table_;   ///< those, then t2 less each of them
  PlaneTransform transform_;
  Index scratch_;  ///< values that each thread has of the next
  FftwBuffer coefficients_;
  FftwBuffer twiddles_;  ///< cos and sin of pi k/(2 t1), k = 0..t1/2, then those of pi k/(2 t2)
};

}  // namespace slipstick::solver
