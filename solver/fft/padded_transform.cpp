#include "solver/fft/padded_transform.hpp"

#include <numbers>

namespace slipstick::solver {
namespace {

Index half_length(Index cells) { return fast_length(2 * cells - 1) / 2; }

/// Products of finite numbers, without the checks for infinities of std::complex.
std::complex<double> times(std::complex<double> a, std::complex<double> b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}
std::complex<double> times_conjugate(std::complex<double> a, std::complex<double> b) {
  return {a.real() * b.real() + a.imag() * b.imag(), a.imag() * b.real() - a.real() * b.imag()};
}

/// Neighbouring columns lie pages apart, so that the processor does not prefetch them: columns to prefetch
/// ahead.
constexpr Index kAhead = 12;

/// exp(-i pi j/m), 0 <= j < n.
std::vector<std::complex<double>> twiddles(Index n, Index m) {
  std::vector<std::complex<double>> result;
  for (Index j = 0; j < n; ++j) {
    const auto factor = std::polar(1.0, -std::numbers::pi * static_cast<double>(j) / static_cast<double>(m));
    result.emplace_back(factor.real(), factor.imag());
  }
  return result;
}

}  // namespace

/// The stride is an odd number of groups: numbers a power of two apart would compete for one cache set.
PaddedTransform::Axis::Axis(Index cells)
    : m(half_length(cells)), stride(((m + kRows - 1) / kRows | 1) * kRows), twiddle(twiddles(cells, m)) {}

PaddedTransform::PaddedTransform(const Grid& grid, std::size_t fields, int threads)
    : grid_(grid),
      fields_(fields),
      threads_(threads),
      axis1_(grid.n1),
      axis2_(grid.n2),
      zero_row_(count(grid.n2)),
      shared_(shared_matrix(grid)),
      layout_(layout()),
      columns_(2 * fields * layout_.field) {
  for (int thread = 0; thread < threads; ++thread) scratch_.emplace_back(2 * count(scratch_size()));
  const auto plan = [&](Index length, Index out, int direction) {
    auto* const start = scratch_.front().complex();
    return FftwPlan(plan_transform(static_cast<int>(length), start, start + out, direction));
  };
  plans_ = {plan(axis2_.m, kRows * axis2_.stride, FFTW_FORWARD),
            plan(axis2_.m, kRows * axis2_.stride, FFTW_BACKWARD), plan(axis1_.m, axis1_.stride, FFTW_FORWARD),
            plan(axis1_.m, axis1_.stride, FFTW_BACKWARD)};
}

void PaddedTransform::execute(const FftwPlan& plan, Complex* in, Complex* out) {
  using Number = fftw_complex;
  fftw_execute_dft(plan.get(), reinterpret_cast<Number*>(in), reinterpret_cast<Number*>(out));
}

auto PaddedTransform::column(std::size_t field, Index column) -> Complex* {
  return as_complex(columns_) + static_cast<Index>(field * layout_.field) + column * axis1_.stride;
}

auto PaddedTransform::rows_of(std::size_t field, Index group) -> Complex* {
  return as_complex(columns_) + static_cast<Index>(field * layout_.field) +
         (group - layout_.first_group) * layout_.group;
}

auto PaddedTransform::layout() const -> Layout {
  if (!grid_.ranks.several()) return {count(columns() * axis1_.stride), axis1_.stride, kRows, 0};
  return {count(shared_.size() / 2), kRows, shared_.row_step() / 2, own_groups(grid_).first};
}

RankTranspose PaddedTransform::shared_matrix(const Grid& grid) {
  static_assert(kRowsOfBand % kRows == 0);
  return {grid.ranks, (grid.n1 + kRows - 1) / kRows, rows_of_rank(grid.n1, grid.ranks) / kRows,
          half_length(grid.n2) + 1, 2 * kRows};
}

IndexRange PaddedTransform::own_groups(const Grid& grid) {
  const IndexRange rows = own_rows(grid);
  return {(rows.first + kRows - 1) / kRows, (rows.last + kRows - 1) / kRows};
}

IndexRange PaddedTransform::own_columns(const Grid& grid) { return shared_matrix(grid).own_columns(); }

auto PaddedTransform::spectrum_of(int thread) -> Spectrum {
  Complex* const start = scratch(thread);
  return {{start, start + 2 * axis1_.stride}, {start + axis1_.stride, start + 3 * axis1_.stride}};
}

/// work(thread, field, first row, index of the field's first value) for all groups of rows of this rank.
template <typename Work>
void PaddedTransform::in_groups(std::size_t values, const Work& work) {
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

void PaddedTransform::forward_rows(std::span<const double> fields) {
  in_groups(fields.size(), [&](int thread, std::size_t field, Index first_row, Index start) {
    forward_group(thread, field, first_row, fields.data() + start);
  });
}

void PaddedTransform::backward_rows(std::span<double> fields) {
  in_groups(fields.size(), [&](int thread, std::size_t field, Index first_row, Index start) {
    backward_group(thread, field, first_row, fields.data() + start);
  });
}

/// Rows past the last are zero.
void PaddedTransform::forward_group(int thread, std::size_t field, Index first_row, const double* values) {
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

/// The spectra X and Y of two real rows from that of x + i y: 2 X(k) = Z(k) + conj Z(-k), 2 i Y(k) = Z(k) -
/// conj Z(-k).
void PaddedTransform::separate(std::size_t field, Index first_row, const Complex* spectra) {
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
void PaddedTransform::join(std::size_t field, Index first_row, Complex* spectra) {
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
  for (Index k = 0; evens + k < columns(); ++k)
    join_column(evens + k, k, axis2_.m - 1 - k, spectra + axis2_.stride);
}

void PaddedTransform::backward_group(int thread, std::size_t field, Index first_row, double* values) {
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

/// A column as contiguous numbers: on several ranks, whose groups of rows lie apart, a copy.
auto PaddedTransform::gathered(int thread, std::size_t field, Index column_index) -> Complex* {
  if (!grid_.ranks.several()) return column(field, column_index);
  Complex* const values = padded(thread);
  shared_.each_row(reals(field), column_index, [&](Index group, const double* from) {
    __builtin_prefetch(from + kAhead * 2 * layout_.group);
    std::copy_n(reinterpret_cast<const Complex*>(from), kRows, values + group * kRows);
  });
  return values;
}

void PaddedTransform::forward_column(int thread, std::size_t field, Index column_index) {
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

void PaddedTransform::backward_column(int thread, std::size_t field, Index column_index) {
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

}  // namespace slipstick::solver
