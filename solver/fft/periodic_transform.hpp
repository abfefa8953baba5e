#pragma once

#include <algorithm>
#include <cstring>
#include <span>
#include <vector>

#include "solver/fft/fftw.hpp"
#include "solver/fft/rank_transpose.hpp"
#include "solver/grid/threads.hpp"

namespace slipstick::solver {

/// Fourier transforms of real fields over a period of n1 x n2 values, with `samples` rows that may differ
/// from zero: for convolution over a period. PaddedTransform is for linear convolution, where the period is
/// twice the field in each direction.
///
/// 1. Rows with samples: real to complex, one by one, from a thread's own memory (FFTW plans in place three
///    times as slowly).
/// 2. On several ranks: a transposition, from each rank's own rows to its own columns.
/// 3. Columns: a cache line of them at a time, forward, multiplied by the caller, and back.
/// 4. The inverse of steps 2 and 1. The result is n1 n2 times the inverse.
///
/// The bits do not depend on the number of threads and ranks.
class PeriodicTransform {
 public:
  /// Columns in a cache line.
  static constexpr Index kColumns = 64 / static_cast<Index>(2 * sizeof(double));

  struct Shape {
    Index n1;
    Index n2;
    Index fields;
    Index samples;                                                         ///< rows that are not zero
    Index (*place)(Index i, Index n1) = [](Index i, Index) { return i; };  ///< the row of sample i
    Ranks ranks = {};                                                      ///< that share the samples
  };
  /// `count` columns from the first one on: row k of a field starts at row(field, k).
  struct Columns {
    double* start;
    Index field_stride;
    Index first;
    Index count;
    double* row(Index field, Index k) const { return start + field * field_stride + k * 2 * kColumns; }
  };

  /// memory: for the plane, if it is large enough; aligned for FFTW, not owned, and overwritten by each transform.
  PeriodicTransform(const Shape& shape, int threads, std::span<double> memory = {})
      : shape_(shape),
        threads_(threads),
        own_samples_(own_rows(shape.samples, shape.ranks)),
        shared_(shared_matrix(shape)),
        row_stride_(shared_.row_step()),
        idle_memory_(memory.subspan(std::min(plane_size(shape), memory.size()))),
        own_plane_(memory.size() < plane_size(shape) ? FftwBuffer(plane_size(shape)) : FftwBuffer()),
        plane_(memory.size() < plane_size(shape) ? own_plane_.data() : memory.data()) {
    auto* const spectrum = numbers(plane_);
    const int length = static_cast<int>(shape.n2);
    for (int thread = 0; thread < threads; ++thread) {
      own_rows_.emplace_back(count(row_stride_));
      scratch_.emplace_back(count(shape.fields * columns_size()));
    }
    auto* const columns = scratch_.front().complex();
    constexpr int kStep = static_cast<int>(kColumns);
    const FftwLines lines{static_cast<int>(shape.n1), kStep, kStep, 1, kStep, 1};
    plans_ = {FftwPlan(plan_row_forward(length, own_row(0), spectrum)),
              FftwPlan(plan_row_backward(length, spectrum, own_row(0))),
              FftwPlan(plan_transforms(lines, columns, columns, FFTW_FORWARD)),
              FftwPlan(plan_transforms(lines, columns, columns, FFTW_BACKWARD))};
  }

  /// Numbers of the plane, and the memory beyond them.
  static std::size_t plane_size(const Shape& shape) { return count(shape.fields * shared_matrix(shape).size()); }
  std::span<double> idle_memory() const { return idle_memory_; }
  int threads() const { return threads_; }
  /// work(thread, field, i) for the samples of this rank in the first `fields` fields.
  template <typename Work>
  void each_sample(Index fields, const Work& work) const {
    const Index own = own_samples_.count();
    in_parts(threads_, fields * own, [&](int thread, Index first, Index last) {
      for (Index k = first; k < last; ++k) work(thread, k / own, own_samples_.first + k % own);
    });
  }
  /// This rank's columns.
  static IndexRange own_columns(const Shape& shape) {
    const IndexRange batches = shared_matrix(shape).own_columns();
    const Index columns = shape.n2 / 2 + 1;
    return {std::min(batches.first * kColumns, columns), std::min(batches.last * kColumns, columns)};
  }

  /// A thread's n2 values, before or after their transform.
  double* own_row(int thread) { return own_rows_[count(thread)].data(); }
  /// True if values are aligned as a thread's own row is: the plans need that.
  static bool is_aligned(double* values) { return fftw_alignment_of(values) == 0; }
  /// values: n2 aligned ones; may be overwritten.
  void forward_sample(double* values, Index field, Index i) {
    fftw_execute_dft_r2c(plans_.row_forward.get(), values, numbers(sample(field, i)));
  }
  /// Overwrites the sample's row.
  void backward_sample(double* values, Index field, Index i) {
    fftw_execute_dft_c2r(plans_.row_backward.get(), numbers(sample(field, i)), values);
  }

  /// For all columns of this rank: the first `inputs` fields forward, work(columns), the first
  /// `outputs` fields back.
  template <typename Work>
  void through_columns(Index inputs, Index outputs, const Work& work) {
    for (Index field = 0; field < inputs; ++field) shared_.to_columns(plane(field));
    const IndexRange own = shared_.own_columns();
    in_parts(threads_, own.count(), [&](int thread, Index begin, Index end) {
      double* const scratch = scratch_[count(thread)].data();
      for (Index batch = begin; batch < end; ++batch) {
        for (Index field = 0; field < inputs; ++field) {
          double* const columns = scratch + field * columns_size();
          read_batch(field, batch, columns);
          fftw_execute_dft(plans_.column_forward.get(), numbers(columns), numbers(columns));
        }
        const Index first = (own.first + batch) * kColumns;
        work(Columns{scratch, columns_size(), first, std::min(kColumns, shape_.n2 / 2 + 1 - first)});
        for (Index field = 0; field < outputs; ++field) {
          double* const columns = scratch + field * columns_size();
          fftw_execute_dft(plans_.column_backward.get(), numbers(columns), numbers(columns));
          write_batch(columns, field, batch);
        }
      }
    });
    for (Index field = 0; field < outputs; ++field) shared_.to_rows(plane(field));
  }

  Index row_stride() const { return row_stride_; }

 private:
  static constexpr Index kLine = 64 / static_cast<Index>(sizeof(double));  ///< reals in a cache line
  /// Rows lie far apart, so that the processor does not prefetch them: this many are prefetched here.
  static constexpr Index kAhead = 12;

  /// A cache line is an entry.
  static RankTranspose shared_matrix(const Shape& shape) {
    RankTranspose shared{shape.ranks, shape.samples, rows_of_rank(shape.samples, shape.ranks),
                         (shape.n2 / 2 + kColumns) / kColumns, kLine};
    shared.pad = 1 - shape.ranks.number() * shared.columns_of_rank() % 2;
    return shared;
  }
  Index columns_size() const { return 2 * kColumns * shape_.n1; }
  double* plane(Index field) { return plane_ + field * shared_.size(); }
  /// n2/2 + 1 complex numbers, each its real, then its imaginary part.
  double* sample(Index field, Index i) { return plane(field) + (i - own_samples_.first) * row_stride_; }

  void read_batch(Index field, Index batch, double* columns) {
    shared_.each_row(plane(field), batch, [&](Index i, const double* from) {
      __builtin_prefetch(from + kAhead * row_stride_);
      std::memcpy(columns + shape_.place(i, shape_.n1) * kLine, from, kLine * sizeof(double));
    });
    for (Index i = shape_.samples; i < shape_.n1; ++i) {
      std::fill_n(columns + shape_.place(i, shape_.n1) * kLine, kLine, 0.0);
    }
  }
  void write_batch(const double* columns, Index field, Index batch) {
    shared_.each_row(plane(field), batch, [&](Index i, double* to) {
      __builtin_prefetch(to + kAhead * row_stride_, 1);
      std::memcpy(to, columns + shape_.place(i, shape_.n1) * kLine, kLine * sizeof(double));
    });
  }
  static fftw_complex* numbers(double* row) { return reinterpret_cast<fftw_complex*>(row); }

  Shape shape_;
  int threads_;
  IndexRange own_samples_;
  RankTranspose shared_;
  /// Reals from one row to the next: an odd number of cache lines, so that a column is spread over the cache
  /// whatever its length.
  Index row_stride_;
  std::span<double> idle_memory_;
  FftwBuffer own_plane_;
  double* plane_;
  std::vector<FftwBuffer> own_rows_;  ///< for each thread
  std::vector<FftwBuffer> scratch_;   ///< for each thread: columns while they are transformed
  PlanePlans plans_;
};

}  // namespace slipstick::solver
