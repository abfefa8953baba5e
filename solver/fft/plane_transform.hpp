#pragma once

#include <algorithm>

#include "solver/fft/fftw.hpp"
#include "solver/grid/threads.hpp"

namespace slipstick::solver {

/// Real fields of n1 x n2 values that are Fourier transformed in place: a workspace, the plans for it. Rows
/// go one by one, columns a cache line of them at a time; on so many threads, with the same result on any.
template <typename Real>
class PlaneTransform {
 public:
  /// Columns that lie in a cache line.
  static constexpr Index kColumns = 64 / static_cast<Index>(2 * sizeof(Real));

  /// planner_flags: FFTW's.
  PlaneTransform(Index n1, Index n2, Index fields, int threads, unsigned planner_flags)
      : n1_(n1),
        threads_(threads),
        row_stride_(padded_row(n2)),
        columns_(n2 / 2 + 1),
        buffer_(static_cast<std::size_t>(size(n1, n2, fields))) {
    auto* const spectrum = buffer_.complex();
    const int length = static_cast<int>(n2);
    row_forward_ =
        FftwPlan<Real>(Fftw<Real>::plan_row_forward(length, buffer_.data(), spectrum, planner_flags));
    row_backward_ =
        FftwPlan<Real>(Fftw<Real>::plan_row_backward(length, spectrum, buffer_.data(), planner_flags));
    const int step = static_cast<int>(row_stride_ / 2);
    const FftwLines lines{static_cast<int>(n1), static_cast<int>(kColumns), step, 1, step, 1};
    column_forward_ =
        FftwPlan<Real>(Fftw<Real>::plan_lines(lines, spectrum, spectrum, FFTW_FORWARD, planner_flags));
    column_backward_ =
        FftwPlan<Real>(Fftw<Real>::plan_lines(lines, spectrum, spectrum, FFTW_BACKWARD, planner_flags));
  }

  int threads() const { return threads_; }

  /// Row i of a field's n2 values, or of its n2/2 + 1 complex numbers: each its real, then its imaginary
  /// part.
  Real* row(Index field, Index i) { return buffer_.data() + (field * n1_ + i) * row_stride_; }
  void forward_row(Index field, Index i) {
    Fftw<Real>::execute(row_forward_.get(), row(field, i), spectrum(field, i));
  }
  void backward_row(Index field, Index i) {
    Fftw<Real>::execute(row_backward_.get(), spectrum(field, i), row(field, i));
  }

  /// The fields' columns forward, a cache line of them at a time, work(first, count) on the complex numbers
  /// [first, first + count) of each row, and back.
  template <typename Work>
  void through_columns(Index fields, const Work& work) {
    in_parts(threads_, batches(), [&](int, Index begin, Index end) {
      for (Index batch = begin; batch < end; ++batch) {
        for (Index field = 0; field < fields; ++field) forward_columns(field, batch);
        work(batch * kColumns, std::min(kColumns, columns_ - batch * kColumns));
        for (Index field = 0; field < fields; ++field) backward_columns(field, batch);
      }
    });
  }
  /// All columns of a field.
  void forward_columns(Index field) {
    in_parts(threads_, batches(), [&](int, Index begin, Index end) {
      for (Index batch = begin; batch < end; ++batch) forward_columns(field, batch);
    });
  }
  /// n1 n2 times the inverse of forward, with the rows.
  void backward_columns(Index field) {
    in_parts(threads_, batches(), [&](int, Index begin, Index end) {
      for (Index batch = begin; batch < end; ++batch) backward_columns(field, batch);
    });
  }

  /// Reals from one row to the next.
  Index row_stride() const { return row_stride_; }
  std::size_t bytes() const { return buffer_.bytes(); }
  /// Reals in the workspace.
  static Index size(Index n1, Index n2, Index fields) { return fields * n1 * padded_row(n2); }

 private:
  /// An odd number of cache lines, so that a column is spread over the cache whatever its length.
  static Index padded_row(Index n2) {
    constexpr Index line = 64 / static_cast<Index>(sizeof(Real));
    const Index lines = (2 * (n2 / 2 + 1) + line - 1) / line;
    return (lines + 1 - lines % 2) * line;
  }
  typename Fftw<Real>::Complex* spectrum(Index field, Index i) {
    return reinterpret_cast<typename Fftw<Real>::Complex*>(row(field, i));
  }
  Index batches() const { return (columns_ + kColumns - 1) / kColumns; }
  void forward_columns(Index field, Index batch) {
    auto* const columns = spectrum(field, 0) + batch * kColumns;
    Fftw<Real>::execute(column_forward_.get(), columns, columns);
  }
  void backward_columns(Index field, Index batch) {
    auto* const columns = spectrum(field, 0) + batch * kColumns;
    Fftw<Real>::execute(column_backward_.get(), columns, columns);
  }

  Index n1_;
  int threads_;
  Index row_stride_;
  Index columns_;
  FftwBuffer<Real> buffer_;
  FftwPlan<Real> row_forward_;
  FftwPlan<Real> row_backward_;
  FftwPlan<Real> column_forward_;
  FftwPlan<Real> column_backward_;
};

}  // namespace slipstick::solver
