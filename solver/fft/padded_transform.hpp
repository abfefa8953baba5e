#pragma once

#include <algorithm>
#include <array>
#include <complex>
#include <numbers>
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

  /// For one or two fields at a time. least_memory: numbers that memory() has at least.
  PaddedTransform(const Grid& grid, std::size_t fields, int threads, std::size_t least_memory = 0)
      : grid_(grid),
        fields_(fields),
        threads_(threads),
        axis1_(grid.n1),
        axis2_(grid.n2),
        zero_row_(count(grid.n2)),
        shared_(shared_matrix(grid)),
        layout_(layout()),
        memory_size_(std::max(2 * fields * layout_.field, least_memory)),
        columns_(memory_size_) {
    for (int thread = 0; thread < threads; ++thread) scratch_.emplace_back(2 * count(scratch_size()));
    const auto plan = [&](Index length, Index out, int direction) {
      auto* const start = scratch_.front().complex();
      return FftwPlan(plan_transform(static_cast<int>(length), start, start + out, direction));
    };
    plans_ = {plan(axis2_.m, kRows * axis2_.stride, FFTW_FORWARD), plan(axis2_.m, kRows * axis2_.stride, FFTW_BACKWARD),
              plan(axis1_.m, axis1_.stride, FFTW_FORWARD), plan(axis1_.m, axis1_.stride, FFTW_BACKWARD)};
  }

  /// Bytes that all ranks send for one field in one direction.
  static double sent_bytes(const Grid& grid) { return shared_matrix(grid).sent_bytes(); }

  int threads() const { return threads_; }
  /// Scratch, free between applications.
  std::span<double> memory() { return {columns_.data(), memory_size_}; }
  Index padded1() const { return 2 * axis1_.m; }
  Index padded2() const { return 2 * axis2_.m; }
  /// The m2 + 1 frequencies along x2 that determine a real field: first the even ones, then the odd ones.
  Index columns() const { return axis2_.m + 1; }
  /// This rank's columns.
  static IndexRange own_columns(const Grid& grid) { return shared_matrix(grid).own_columns(); }

  /// From the fields' n1*n2 values each to their columns, and back: this rank's rows of them.
  void forward_rows(std::span<const double> fields) {
    in_groups(fields.size(), [&](int thread, std::size_t field, Index first_row, Index start) {
      forward_group(thread, field, first_row, fields.data() + start);
    });
  }

  void backward_rows(std::span<double> fields) {
    in_groups(fields.size(), [&](int thread, std::size_t field, Index first_row, Index start) {
      backward_group(thread, field, first_row, fields.data() + start);
    });
  }

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
    return std::max(2 * kRows * axis2_.stride, (2 * static_cast<Index>(fields_) + turned_and_padded) * axis1_.stride);
  }

  static Index half_length(Index cells) { return fast_length(2 * cells - 1) / 2; }

  /// Products of finite numbers, without the checks for infinities of std::complex.
  static Complex times(Complex a, Complex b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
  }
  static Complex times_conjugate(Complex a, Complex b) {
    return {a.real() * b.real() + a.imag() * b.imag(), a.imag() * b.real() - a.real() * b.imag()};
  }

  /// Neighbouring columns lie pages apart, so that the processor does not prefetch them: columns to prefetch ahead.
  static constexpr Index kAhead = 12;

  /// exp(-i pi j/m), 0 <= j < n.
  static std::vector<Complex> twiddles(Index n, Index m) {
    std::vector<Complex> result;
    for (Index j = 0; j < n; ++j) {
      const auto factor = std::polar(1.0, -std::numbers::pi * static_cast<double>(j) / static_cast<double>(m));
      result.emplace_back(factor.real(), factor.imag());
    }
    return result;
  }

  /// One direction: half of the padded length, numbers from half a spectrum to the next, w^j for j < n.
  struct Axis {
    /// The stride is an odd number of groups: numbers a power of two apart would compete for one cache set.
    explicit Axis(Index cells)
        : m(half_length(cells)), stride(((m + kRows - 1) / kRows | 1) * kRows), twiddle(twiddles(cells, m)) {}
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

  /// work(thread, field, first row, index of the field's first value) for all groups of rows of this rank.
  template <typename Work>
  void in_groups(std::size_t values, const Work& work) {
    const IndexRange own = own_groups(grid_);
    const Index groups = own.count();
    const Index fields = static_cast<Index>(values) / grid_.cells();
    in_parts(threads_, fields * groups, [&](int thread, Index first, Index last) {
      for (Index group = first; group < last; ++group) {
        const Index field = group / groups;
        work(thread, count(field), (own.first + group % groups) * kRows, field * grid_.cells());
      }
    });
  }

  Spectrum spectrum_of(int thread) {
    Complex* const start = scratch(thread);
    return {{start, start + 2 * axis1_.stride}, {start + axis1_.stride, start + 3 * axis1_.stride}};
  }

  Index groups() const { return (grid_.n1 + kRows - 1) / kRows; }

  /// A group of rows in a column is an entry.
  static RankTranspose shared_matrix(const Grid& grid) {
    static_assert(kRowsOfBand % kRows == 0);
    return {grid.ranks, (grid.n1 + kRows - 1) / kRows, rows_of_rank(grid.n1, grid.ranks) / kRows,
            half_length(grid.n2) + 1, 2 * kRows};
  }

  static IndexRange own_groups(const Grid& grid) {
    const IndexRange rows = own_rows(grid);
    return {(rows.first + kRows - 1) / kRows, (rows.last + kRows - 1) / kRows};
  }

  Layout layout() const {
    if (!grid_.ranks.several()) return {count(columns() * axis1_.stride), axis1_.stride, kRows, 0};
    return {count(shared_.size() / 2), kRows, shared_.row_step() / 2, own_groups(grid_).first};
  }

  Complex* column(std::size_t field, Index column) {
    return as_complex(columns_) + static_cast<Index>(field * layout_.field) + column * axis1_.stride;
  }

  /// A column as contiguous numbers: on several ranks, whose groups of rows lie apart, a copy.
  Complex* gathered(int thread, std::size_t field, Index column_index) {
    if (!grid_.ranks.several()) return column(field, column_index);
    Complex* const values = padded(thread);
    shared_.each_row(reals(field), column_index, [&](Index group, const double* from) {
      __builtin_prefetch(from + kAhead * 2 * layout_.group);
      std::copy_n(reinterpret_cast<const Complex*>(from), kRows, values + group * kRows);
    });
    return values;
  }

  /// A group of rows in the first column.
  Complex* rows_of(std::size_t field, Index group) {
    return as_complex(columns_) + static_cast<Index>(field * layout_.field) +
           (group - layout_.first_group) * layout_.group;
  }

  double* reals(std::size_t field) { return columns_.data() + 2 * field * layout_.field; }
  Complex* scratch(int thread) { return as_complex(scratch_[static_cast<std::size_t>(thread)]); }
  Complex* turned(int thread) { return scratch(thread) + 2 * static_cast<Index>(fields_) * axis1_.stride; }
  Complex* padded(int thread) { return turned(thread) + axis1_.stride; }
  static Complex* as_complex(FftwBuffer& buffer) { return reinterpret_cast<Complex*>(buffer.data()); }

  /// Rows past the last are zero.
  void forward_group(int thread, std::size_t field, Index first_row, const double* values) {
    const Index n2 = grid_.n2;
    Complex* const halves = scratch(thread);
    Complex* const spectra = halves + kRows * axis2_.stride;
    const auto row = [&](Index i) { return i < grid_.n1 ? values + i * n2 : zero_row_.data(); };
    for (Index r = 0; r < kRows; r += 2) {
      const double* const real = row(first_row + r);
      const double* const imaginary = row(first_row + r + 1);
      Complex* const even = halves + r * axis2_.stride;
      Complex* const odd = even + axis2_.stride;
      for (Index j = 0; j < n2; ++j) {
        even[j] = {real[j], imaginary[j]};
        odd[j] = times(even[j], axis2_.twiddle[count(j)]);
      }
      std::fill(even + n2, even + axis2_.m, Complex());
      std::fill(odd + n2, odd + axis2_.m, Complex());
      for (const Index half : {r, r + 1}) {
        execute(plans_.row_forward, halves + half * axis2_.stride, spectra + half * axis2_.stride);
      }
    }
    separate(field, first_row, spectra);
  }

  void backward_group(int thread, std::size_t field, Index first_row, double* values) {
    const Index n2 = grid_.n2;
    Complex* const spectra = scratch(thread);
    Complex* const halves = spectra + kRows * axis2_.stride;
    join(field, first_row, spectra);
    for (Index r = 0; r < kRows && first_row + r < grid_.n1; r += 2) {
      for (const Index half : {r, r + 1}) {
        execute(plans_.row_backward, spectra + half * axis2_.stride, halves + half * axis2_.stride);
      }
      const Complex* const even = halves + r * axis2_.stride;
      const Complex* const odd = even + axis2_.stride;
      double* const real = values + (first_row + r) * n2;
      const bool paired = first_row + r + 1 < grid_.n1;
      for (Index j = 0; j < n2; ++j) {
        const Complex value = even[j] + times_conjugate(odd[j], axis2_.twiddle[count(j)]);
        real[j] = value.real();
        if (paired) real[n2 + j] = value.imag();
      }
    }
  }

  /// The spectra X and Y of two real rows from that of x + i y: 2 X(k) = Z(k) + conj Z(-k), 2 i Y(k) = Z(k) -
  /// conj Z(-k).
  void separate(std::size_t field, Index first_row, const Complex* spectra) {
    constexpr double half = 0.5;
    Complex* const start = rows_of(field, first_row / kRows);
    const Index step = layout_.column;
    const Index stride = axis2_.stride;
    const Index last = columns() - 1;
    const auto separate_column = [=](Index to, Index k, Index mirrored, const Complex* pairs) {
      Complex* const out = start + to * step;
      __builtin_prefetch(start + std::min(to + kAhead, last) * step, 1);
      for (Index r = 0; r < kRows; r += 2) {
        const Complex z = pairs[r * stride + k];
        const Complex y = pairs[r * stride + mirrored];
        out[r] = {half * (z.real() + y.real()), half * (z.imag() - y.imag())};
        out[r + 1] = {half * (z.imag() + y.imag()), half * (y.real() - z.real())};
      }
    };
    const Index evens = axis2_.m / 2 + 1;
    separate_column(0, 0, 0, spectra);
    for (Index k = 1; k < evens; ++k) separate_column(k, k, axis2_.m - k, spectra);
    for (Index k = 0; evens + k < columns(); ++k) {
      separate_column(evens + k, k, axis2_.m - 1 - k, spectra + axis2_.stride);
    }
  }

  /// The inverse of separate().
  void join(std::size_t field, Index first_row, Complex* spectra) {
    const Complex* const start = rows_of(field, first_row / kRows);
    const Index step = layout_.column;
    const Index stride = axis2_.stride;
    const Index last = columns() - 1;
    const auto join_column = [=](Index from, Index k, Index mirrored, Complex* pairs) {
      const Complex* const in = start + from * step;
      __builtin_prefetch(start + std::min(from + kAhead, last) * step);
      for (Index r = 0; r < kRows; r += 2) {
        const Complex x = in[r];
        const Complex y = in[r + 1];
        pairs[r * stride + mirrored] = {x.real() + y.imag(), y.real() - x.imag()};
        pairs[r * stride + k] = {x.real() - y.imag(), y.real() + x.imag()};
      }
    };
    const Index evens = axis2_.m / 2 + 1;
    join_column(0, 0, 0, spectra);
    for (Index k = 1; k < evens; ++k) join_column(k, k, axis2_.m - k, spectra);
    for (Index k = 0; evens + k < columns(); ++k) join_column(evens + k, k, axis2_.m - 1 - k, spectra + axis2_.stride);
  }

  void forward_column(int thread, std::size_t field, Index column_index) {
    const Spectrum spectrum = spectrum_of(thread);
    Complex* const values = gathered(thread, field, column_index);
    Complex* const odd = turned(thread);
    // The imaginary part of an odd count's last row is rounding, not zero.
    std::fill(values + grid_.n1, values + std::max(axis1_.m, groups() * kRows), Complex());
    for (Index i = 0; i < grid_.n1; ++i) odd[i] = times(values[i], axis1_.twiddle[count(i)]);
    std::fill(odd + grid_.n1, odd + axis1_.m, Complex());
    execute(plans_.column_forward, values, spectrum.even[field]);
    execute(plans_.column_forward, odd, spectrum.odd[field]);
  }

  void backward_column(int thread, std::size_t field, Index column_index) {
    const Spectrum spectrum = spectrum_of(thread);
    Complex* const even = grid_.ranks.several() ? padded(thread) : column(field, column_index);
    Complex* const odd = turned(thread);
    execute(plans_.column_backward, spectrum.even[field], even);
    execute(plans_.column_backward, spectrum.odd[field], odd);
    for (Index i = 0; i < grid_.n1; ++i) even[i] += times_conjugate(odd[i], axis1_.twiddle[count(i)]);
    std::fill(even + grid_.n1, even + groups() * kRows, Complex());
    if (!grid_.ranks.several()) return;
    shared_.each_row(reals(field), column_index, [&](Index group, double* to) {
      __builtin_prefetch(to + kAhead * 2 * layout_.group, 1);
      std::copy_n(even + group * kRows, kRows, reinterpret_cast<Complex*>(to));
    });
  }

  void execute(const FftwPlan& plan, Complex* in, Complex* out) {
    using Number = fftw_complex;
    fftw_execute_dft(plan.get(), reinterpret_cast<Number*>(in), reinterpret_cast<Number*>(out));
  }

  Grid grid_;
  std::size_t fields_;
  int threads_;
  Axis axis1_;
  Axis axis2_;
  std::vector<double> zero_row_;
  RankTranspose shared_;
  Layout layout_;
  std::size_t memory_size_;
  FftwBuffer columns_;               ///< of all fields
  std::vector<FftwBuffer> scratch_;  ///< for each thread
  PlanePlans plans_;
};

}  // namespace slipstick::solver
