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

/// Fourier transforms of real fields of n1 x n2 cells, padded with zeros to p1 x p2 = 2 m1 x 2 m2 with m1 >=
/// n1 and m2 >= n2: for linear convolution. No transform contains a zero of the padding, which saves half of
/// the work; PeriodicTransform, for convolution over a period, has no padding to save.
///
/// With w = exp(-i pi/m) and m values x_j followed by m zeros, the even frequencies are the transform of x_j,
/// the odd ones the transform of x_j w^j, both of length m. Backward, the first m values are the transform of
/// the even frequencies plus w^-j times the transform of the odd ones.
///
/// 1. Rows: two at a time, as real and imaginary part of one sequence; written to transposed columns.
/// 2. On several ranks: a transposition, from each rank's own rows to its own columns.
/// 3. Columns: one by one, forward, multiplied by the caller, and back, while they are in cache.
/// 4. The inverse of steps 2 and 1.
///
/// The bits do not depend on the number of threads and ranks.
class PaddedTransform {
 public:
  using Complex = std::complex<double>;
  /// One column: for each field the m1 even frequencies along x1 (0, 2, ...), and the odd ones.
  struct Spectrum {
    std::array<Complex*, 2> even;
    std::array<Complex*, 2> odd;
  };

  /// For one or two fields at a time.
  PaddedTransform(const Grid& grid, std::size_t fields, int threads);
  /// Bytes that all ranks send for one field in one direction.
  static double sent_bytes(const Grid& grid) { return shared_matrix(grid).sent_bytes(); }

  int threads() const { return threads_; }
  /// Scratch, free between applications.
  std::span<double> memory() { return {columns_.data(), 2 * fields_ * layout_.field}; }
  Index padded1() const { return 2 * axis1_.m; }
  Index padded2() const { return 2 * axis2_.m; }
  /// The m2 + 1 frequencies along x2 that determine a real field: first the even ones, then the odd ones.
  Index columns() const { return axis2_.m + 1; }
  static IndexRange own_columns(const Grid& grid);  ///< this rank's

  /// From the fields' n1*n2 values each to their columns, and back: this rank's rows of them.
  void forward_rows(std::span<const double> fields);
  void backward_rows(std::span<double> fields);

  /// For all columns of this rank, numbered from 0, on several threads: the first `inputs` fields forward,
  /// work(column, spectrum), the first `outputs` fields back.
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
  /// Rows that are written to a column together: a cache line.
  static constexpr Index kRows = 64 / static_cast<Index>(sizeof(Complex));
  /// A thread's memory: a group of rows before and after its transform; or the two halves of each field's
  /// column, one that is being turned, and on several ranks one that is being padded.
  Index scratch_size() const {
    const Index turned_and_padded = grid_.ranks.several() ? 2 : 1;
    return std::max(2 * kRows * axis2_.stride,
                    (2 * static_cast<Index>(fields_) + turned_and_padded) * axis1_.stride);
  }
  /// One direction: half of the padded length, numbers from half a spectrum to the next, w^j for j < n.
  struct Axis {
    explicit Axis(Index cells);
    Index m;
    Index stride;
    std::vector<Complex> twiddle;
  };
  /// Where a group of kRows rows stands in a column between the passes: complex numbers from one field,
  /// column and group to the next, and the first group of this rank.
  struct Layout {
    std::size_t field;
    Index column;
    Index group;
    Index first_group;
  };

  template <typename Work>
  void in_groups(std::size_t values, const Work& work);
  Spectrum spectrum_of(int thread);
  Index groups() const { return (grid_.n1 + kRows - 1) / kRows; }
  /// A group of rows in a column is an entry.
  static RankTranspose shared_matrix(const Grid& grid);
  static IndexRange own_groups(const Grid& grid);
  Layout layout() const;
  Complex* column(std::size_t field, Index column);
  Complex* gathered(int thread, std::size_t field, Index column);
  /// A group of rows in the first column.
  Complex* rows_of(std::size_t field, Index group);
  double* reals(std::size_t field) { return columns_.data() + 2 * field * layout_.field; }
  Complex* scratch(int thread) { return as_complex(scratch_[static_cast<std::size_t>(thread)]); }
  Complex* turned(int thread) { return scratch(thread) + 2 * static_cast<Index>(fields_) * axis1_.stride; }
  Complex* padded(int thread) { return turned(thread) + axis1_.stride; }
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
  Axis axis1_;
  Axis axis2_;
  std::vector<double> zero_row_;
  RankTranspose shared_;
  Layout layout_;
  FftwBuffer columns_;               ///< of all fields
  std::vector<FftwBuffer> scratch_;  ///< for each thread
  PlanePlans plans_;
};

}  // namespace slipstick::solver
