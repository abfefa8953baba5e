#pragma once

#include <algorithm>
#include <array>
#include <complex>
#include <span>
#include <vector>

#include "solver/fft/fftw.hpp"
#include "solver/fft/rank_transpose.hpp"
#include "solver/grid/threads.hpp"

namespace slipstick::solver {

/// Two-dimensional Fourier transforms of real fields of n1 x n2 cells padded with zeros to p1 x p2 = 2 m1 x
/// 2 m2, where m1 >= n1 and m2 >= n2, without the work that the zeros would cost.
///
/// With w = exp(-i pi/m), a sequence x of m values followed by m zeros has at even frequencies the transform
/// of x, at odd ones that of x_j w^j, each of length m; and the first m values of a backward transform are
/// the transform of the even frequencies plus w^-j times that of the odd ones. All transforms are therefore
/// of length m1 or m2, over contiguous numbers, and nothing is padded.
///
/// Rows go through in pairs, as real and imaginary parts of one sequence. Columns lie transposed, so that
/// each is read from memory once, carried forward, changed and carried back in cache.
///
/// Each of several ranks carries its own rows of the fields and its share of the columns; between the two
/// passes the plane goes from rank to rank, the half of it that is not zero. The values have the same bits on
/// any number of ranks.
class PaddedTransform {
 public:
  using Complex = std::complex<double>;
  /// The columns' spectra of one frequency along x2: for each field the m1 even frequencies along x1 (0, 2,
  /// ...), then the odd ones.
  struct Spectrum {
    std::array<Complex*, 2> even;
    std::array<Complex*, 2> odd;
  };

  /// For one or two fields at a time.
  PaddedTransform(const Grid& grid, std::size_t fields, int threads);
  /// Bytes that all ranks send for one field in one direction.
  static double sent_bytes(const Grid& grid) { return shared_matrix(grid).sent_bytes(); }

  int threads() const { return threads_; }
  /// What it overwrites, and nobody reads between a way forward and back and the next.
  std::span<double> memory() { return {columns_.data(), 2 * fields_ * field_size_}; }
  Index padded1() const { return 2 * m1_; }
  Index padded2() const { return 2 * m2_; }
  /// Frequencies along x2 that hold all of a real field, m2 + 1: first the even ones, then the odd ones.
  Index columns() const { return m2_ + 1; }
  /// Those of this rank.
  static IndexRange own_columns(const Grid& grid);

  /// From the fields' n1*n2 values each to their columns, and back: this rank's rows of them.
  void forward_rows(std::span<const double> fields);
  void backward_rows(std::span<double> fields);

  /// The first `inputs` columns forward, work(column, spectrum), the first `outputs` columns back, for all
  /// columns of this rank, numbered from 0; on several threads at the same time.
  template <typename Work>
  void through_columns(std::size_t inputs, std::size_t outputs, const Work& work) {
    for (std::size_t field = 0; field < inputs; ++field) shared_.to_columns(reals(field));
    in_parts(threads_, own_columns(grid_).count(), [&](int thread, Index first, Index last) {
      const Spectrum spectrum = spectrum_of(thread);
      for (Index column = first; column < last; ++column) {
        for (std::size_t field = 0; field < inputs; ++field) forward_column(thread, field, column);
        work(column, spectrum);
        for (std::size_t field = 0; field < outputs; ++field) backward_column(thread, field, column);
      }
    });
    for (std::size_t field = 0; field < outputs; ++field) shared_.to_rows(reals(field));
  }

 private:
  /// Rows that are written to the columns together: a cache line.
  static constexpr Index kRows = 64 / static_cast<Index>(sizeof(Complex));
  /// A count of groups of kRows, rounded up to odd: numbers a power of two apart would compete for one cache
  /// set.
  static Index stride(Index length) { return ((length + kRows - 1) / kRows | 1) * kRows; }
  /// A thread's memory holds a group of rows before and after its transform; or the two halves of each
  /// field's column and one that is being turned, and on several ranks one that is being padded.
  static Index scratch_size(const Grid& grid, std::size_t fields, Index stride1, Index stride2) {
    const Index turned_and_padded = grid.ranks.several() ? 2 : 1;
    return std::max(2 * kRows * stride2, (2 * static_cast<Index>(fields) + turned_and_padded) * stride1);
  }

  template <typename Work>
  void in_groups(std::size_t values, const Work& work);
  Spectrum spectrum_of(int thread);
  Index groups() const { return (grid_.n1 + kRows - 1) / kRows; }
  /// What goes from rank to rank, and of that the rows of this one.
  static RankTranspose shared_matrix(const Grid& grid);
  static IndexRange own_groups(const Grid& grid);
  /// Complex numbers that a field takes.
  static std::size_t field_size(const Grid& grid, Index columns, Index stride1);
  Complex* column(std::size_t field, Index column);
  Complex* gathered(int thread, std::size_t field, Index column);
  /// Where a group of rows stands in a column between the passes.
  Complex* rows_of(std::size_t field, Index column, Index group);
  double* reals(std::size_t field) { return columns_.data() + 2 * field * field_size_; }
  Complex* scratch(int thread) { return as_complex(scratch_[static_cast<std::size_t>(thread)]); }
  Complex* turned(int thread) { return scratch(thread) + 2 * static_cast<Index>(fields_) * stride1_; }
  Complex* padded(int thread) { return turned(thread) + stride1_; }
  static Complex* as_complex(FftwBuffer& buffer) { return reinterpret_cast<Complex*>(buffer.data()); }

  void forward_group(int thread, std::size_t field, Index first_row, const double* values);
  void backward_group(int thread, std::size_t field, Index first_row, double* values);
  void separate(std::size_t field, Index first_row, const Complex* spectra);
  void join(std::size_t field, Index first_row, Complex* spectra);
  void forward_column(int thread, std::size_t field, Index column);
  void backward_column(int thread, std::size_t field, Index column);
  void execute(const FftwPlan& plan, Complex* in, Complex* out);

  Grid grid_;
  std::size_t fields_;
  int threads_;
  Index m1_;
  Index m2_;
  Index stride1_;                  ///< from half a column's spectrum to the next
  Index stride2_;                  ///< from half a row's spectrum to the next
  std::vector<Complex> twiddle1_;  ///< w^j along x1, j < n1
  std::vector<Complex> twiddle2_;
  std::vector<double> zero_row_;
  bool several_;           ///< ranks
  RankTranspose shared_;   ///< where there are
  IndexRange own_groups_;  ///< of kRows rows
  std::size_t field_size_;
  Index column_step_;                ///< from column to column while rows are carried
  Index group_step_;                 ///< then from group to group of a column's rows
  FftwBuffer columns_;               ///< of all fields
  std::vector<FftwBuffer> scratch_;  ///< for each thread
  FftwPlan row_forward_;
  FftwPlan row_backward_;
  FftwPlan column_forward_;
  FftwPlan column_backward_;
};

}  // namespace slipstick::solver
