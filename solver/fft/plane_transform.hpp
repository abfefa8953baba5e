#pragma once

#include <algorithm>
#include <cstring>
#include <span>
#include <vector>

#include "solver/fft/fftw.hpp"
#include "solver/fft/rank_transpose.hpp"
#include "solver/grid/threads.hpp"

namespace slipstick::solver {

/// Fields of n1 x n2 values. `samples` of the rows hold samples, sample i in row place(i, n1), and the others
/// are zero. whole: all rows are kept, for work on the whole plane; on one rank alone.
struct PlaneShape {
  Index n1;
  Index n2;
  Index fields;
  Index samples;
  Index (*place)(Index i, Index n1) = [](Index i, Index) { return i; };
  bool whole = false;
  Ranks ranks = {};  ///< that share the samples
};

/// Some columns of the fields' complex numbers: row k has those from the first one on.
struct PlaneColumns {
  double* start;
  Index row_stride;
  Index field_stride;
  Index first;
  Index count;
  double* row(Index field, Index k) const { return start + field * field_stride + k * row_stride; }
};

/// Real fields that are Fourier transformed: a workspace, the plans for it. Rows go one by one, from and to a
/// thread's own (FFTW finds a plan three times as fast as in place), columns a cache line of them at a time;
/// the number of threads changes no bit. Each of several ranks carries its own rows of samples and
/// its share of the columns.
class PlaneTransform {
 public:
  /// Columns that lie in a cache line.
  static constexpr Index kColumns = 64 / static_cast<Index>(2 * sizeof(double));

  /// memory: where to keep the plane if that is large enough, aligned for FFTW and free whenever rows go
  /// forward; not owned.
  PlaneTransform(const PlaneShape& shape, int threads, std::span<double> memory = {})
      : shape_(shape),
        threads_(threads),
        row_stride_(row_stride(shape)),
        columns_(shape.n2 / 2 + 1),
        own_samples_(own_rows(shape.samples, shape.ranks)),
        shared_(shared_matrix(shape)),
        field_size_(field_size(shape)),
        own_plane_(memory.size() < plane_size() ? FftwBuffer(plane_size()) : FftwBuffer()),
        plane_(memory.size() < plane_size() ? own_plane_.data() : memory.data()) {
    auto* const spectrum = numbers(plane_);
    const int length = static_cast<int>(shape.n2);
    for (int thread = 0; thread < threads; ++thread) {
      own_rows_.emplace_back(count(row_stride_));
      if (!shape.whole) scratch_.emplace_back(count(scratch_size(shape)));
    }
    row_forward_ = FftwPlan(plan_row_forward(length, own_row(0), spectrum));
    row_backward_ = FftwPlan(plan_row_backward(length, spectrum, own_row(0)));
    const int step = static_cast<int>(shape.whole ? row_stride_ / 2 : kColumns);
    auto* const columns = shape.whole ? spectrum : scratch_.front().complex();
    const FftwLines lines{static_cast<int>(shape.n1), static_cast<int>(kColumns), step, 1, step, 1};
    column_forward_ = FftwPlan(plan_transforms(lines, columns, columns, FFTW_FORWARD));
    column_backward_ = FftwPlan(plan_transforms(lines, columns, columns, FFTW_BACKWARD));
  }

  int threads() const { return threads_; }

  /// The samples whose rows this rank carries.
  const IndexRange& own_samples() const { return own_samples_; }
  /// Columns that it does.
  static IndexRange own_columns(const PlaneShape& shape) {
    const IndexRange batches = shared_matrix(shape).own_columns();
    const Index columns = shape.n2 / 2 + 1;
    return {std::min(batches.first * kColumns, columns), std::min(batches.last * kColumns, columns)};
  }

  /// A thread's n2 values, before or after their transform.
  double* own_row(int thread) { return own_rows_[count(thread)].data(); }
  /// Whether values may stand for a thread's own: the plans are for memory that is aligned as that is.
  static bool is_aligned(double* values) { return fftw_alignment_of(values) == 0; }
  /// Row of sample i: n2/2 + 1 complex numbers, each its real, then its imaginary part.
  double* sample(Index field, Index i) {
    return row(field, shape_.whole ? shape_.place(i, shape_.n1) : i - own_samples_.first);
  }
  /// values: a thread's own, or others that are aligned; may be overwritten.
  void forward_sample(double* values, Index field, Index i) {
    fftw_execute_dft_r2c(row_forward_.get(), values, numbers(sample(field, i)));
  }
  /// Likewise, to there; overwrites the sample's row.
  void backward_sample(double* values, Index field, Index i) {
    fftw_execute_dft_c2r(row_backward_.get(), numbers(sample(field, i)), values);
  }
  /// Zeroes the rows of a whole plane that hold no samples. Transforms write in them.
  void clear_others(Index field) {
    in_parts(threads_, shape_.n1 - shape_.samples, [&](int, Index begin, Index end) {
      for (Index i = shape_.samples + begin; i < shape_.samples + end; ++i) {
        std::fill_n(row(field, shape_.place(i, shape_.n1)), row_stride_, 0.0);
      }
    });
  }

  /// A row of those that are kept.
  double* row(Index field, Index k) { return plane_ + field * field_size_ + k * row_stride_; }
  /// All columns of a whole plane.
  PlaneColumns all_columns() { return {plane_, row_stride_, field_size_, 0, columns_}; }

  /// This rank's columns of the fields forward, a cache line of them at a time, work(thread, these), and
  /// back; not of a whole plane.
  template <typename Work>
  void through_columns(Index fields, const Work& work) {
    for (Index field = 0; field < fields; ++field) shared_.to_columns(row(field, 0));
    const IndexRange own = shared_.own_columns();
    in_parts(threads_, own.count(), [&](int thread, Index begin, Index end) {
      double* const scratch = scratch_[count(thread)].data();
      const Index size = 2 * kColumns * shape_.n1;
      for (Index batch = begin; batch < end; ++batch) {
        for (Index field = 0; field < fields; ++field) {
          read_batch(field, batch, scratch + field * size);
          fftw_execute_dft(column_forward_.get(), numbers(scratch + field * size),
                           numbers(scratch + field * size));
        }
        const Index first = (own.first + batch) * kColumns;
        work(thread, PlaneColumns{scratch, 2 * kColumns, size, first, std::min(kColumns, columns_ - first)});
        for (Index field = 0; field < fields; ++field) {
          fftw_execute_dft(column_backward_.get(), numbers(scratch + field * size),
                           numbers(scratch + field * size));
          write_batch(scratch + field * size, field, batch);
        }
      }
    });
    for (Index field = 0; field < fields; ++field) shared_.to_rows(row(field, 0));
  }
  /// All columns of a field of a whole plane.
  void forward_columns(Index field) {
    in_parts(threads_, batches(shape_), [&](int, Index begin, Index end) {
      for (Index batch = begin; batch < end; ++batch) forward_columns(field, batch);
    });
  }
  /// n1 n2 times the inverse of forward, with the rows.
  void backward_columns(Index field) {
    in_parts(threads_, batches(shape_), [&](int, Index begin, Index end) {
      for (Index batch = begin; batch < end; ++batch) backward_columns(field, batch);
    });
  }

  /// Reals from one row to the next: an odd number of cache lines, so that a column is spread over the cache
  /// whatever its length.
  Index row_stride() const { return row_stride_; }

 private:
  static constexpr Index kLine = 64 / static_cast<Index>(sizeof(double));  ///< reals in a cache line
  /// Rows lie where the processor does not look ahead: they are prefetched this many before their turn.
  static constexpr Index kAhead = 12;

  static Index batches(const PlaneShape& shape) { return (shape.n2 / 2 + kColumns) / kColumns; }
  static Index row_stride(const PlaneShape& shape) { return shared_matrix(shape).row_step(); }
  /// What goes from rank to rank: a cache line is an entry.
  static RankTranspose shared_matrix(const PlaneShape& shape) {
    RankTranspose shared{shape.ranks, shape.samples, rows_of_rank(shape.samples, shape.ranks), batches(shape),
                         kLine};
    shared.pad = 1 - shape.ranks.number() * shared.columns_of_rank() % 2;
    return shared;
  }
  static Index field_size(const PlaneShape& shape) {
    return shape.whole ? shape.n1 * row_stride(shape) : shared_matrix(shape).size();
  }
  std::size_t plane_size() const { return count(shape_.fields * field_size_); }
  static Index scratch_size(const PlaneShape& shape) { return shape.fields * 2 * kColumns * shape.n1; }

  /// Samples between there and where they are transformed.
  void read_batch(Index field, Index batch, double* columns) {
    shared_.each_row(row(field, 0), batch, [&](Index i, const double* from) {
      __builtin_prefetch(from + kAhead * row_stride_);
      std::memcpy(columns + shape_.place(i, shape_.n1) * kLine, from, kLine * sizeof(double));
    });
    for (Index i = shape_.samples; i < shape_.n1; ++i) {
      std::fill_n(columns + shape_.place(i, shape_.n1) * kLine, kLine, 0.0);
    }
  }
  void write_batch(const double* columns, Index field, Index batch) {
    shared_.each_row(row(field, 0), batch, [&](Index i, double* to) {
      __builtin_prefetch(to + kAhead * row_stride_, 1);
      std::memcpy(to, columns + shape_.place(i, shape_.n1) * kLine, kLine * sizeof(double));
    });
  }

  static fftw_complex* numbers(double* row) { return reinterpret_cast<fftw_complex*>(row); }
  void forward_columns(Index field, Index batch) {
    auto* const columns = numbers(row(field, 0)) + batch * kColumns;
    fftw_execute_dft(column_forward_.get(), columns, columns);
  }
  void backward_columns(Index field, Index batch) {
    auto* const columns = numbers(row(field, 0)) + batch * kColumns;
    fftw_execute_dft(column_backward_.get(), columns, columns);
  }

  PlaneShape shape_;
  int threads_;
  Index row_stride_;
  Index columns_;
  IndexRange own_samples_;
  RankTranspose shared_;
  Index field_size_;  ///< reals from one field to the next
  FftwBuffer own_plane_;
  double* plane_;
  std::vector<FftwBuffer> own_rows_;  ///< for each thread
  std::vector<FftwBuffer> scratch_;   ///< for each thread: columns while they are transformed
  FftwPlan row_forward_;
  FftwPlan row_backward_;
  FftwPlan column_forward_;
  FftwPlan column_backward_;
};

}  // namespace slipstick::solver
