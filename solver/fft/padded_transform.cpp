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

/// Neighbouring columns lie pages apart, where the processor does not look ahead: they are prefetched
/// this many columns before their turn.
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

PaddedTransform::PaddedTransform(const Grid& grid, std::size_t fields, int threads)
    : grid_(grid),
      fields_(fields),
      threads_(threads),
      m1_(half_length(grid.n1)),
      m2_(half_length(grid.n2)),
      stride1_(stride(m1_)),
      stride2_(stride(m2_)),
      twiddle1_(twiddles(grid.n1, m1_)),
      twiddle2_(twiddles(grid.n2, m2_)),
      zero_row_(count(grid.n2)),
      several_(grid.ranks.several()),
      shared_(shared_matrix(grid)),
      own_groups_(own_groups(grid)),
      field_size_(field_size(grid, columns(), stride1_)),
      column_step_(several_ ? kRows : stride1_),
      group_step_(several_ ? shared_.row_step() / 2 : kRows),
      columns_(2 * fields * field_size_) {
  const Index size = scratch_size(grid, fields, stride1_, stride2_);
  for (int thread = 0; thread < threads; ++thread) scratch_.emplace_back(2 * count(size));
  const auto plan = [&](Index length, Index out, int direction) {
    auto* const start = scratch_.front().complex();
    return FftwPlan(plan_transform(static_cast<int>(length), start, start + out, direction));
  };
  row_forward_ = plan(m2_, kRows * stride2_, FFTW_FORWARD);
  row_backward_ = plan(m2_, kRows * stride2_, FFTW_BACKWARD);
  column_forward_ = plan(m1_, stride1_, FFTW_FORWARD);
  column_backward_ = plan(m1_, stride1_, FFTW_BACKWARD);
}

void PaddedTransform::execute(const FftwPlan& plan, Complex* in, Complex* out) {
  using Number = fftw_complex;
  fftw_execute_dft(plan.get(), reinterpret_cast<Number*>(in), reinterpret_cast<Number*>(out));
}

auto PaddedTransform::column(std::size_t field, Index column) -> Complex* {
  return as_complex(columns_) + static_cast<Index>(field * field_size_) + column * stride1_;
}

/// Inlined: the innermost loops of separate() and join() ask for it twice a column.
inline auto PaddedTransform::rows_of(std::size_t field, Index column, Index group) -> Complex* {
  return as_complex(columns_) + static_cast<Index>(field * field_size_) + column * column_step_ +
         (group - own_groups_.first) * group_step_;
}

std::size_t PaddedTransform::field_size(const Grid& grid, Index columns, Index stride1) {
  if (!grid.ranks.several()) return count(columns * stride1);
  return count(shared_matrix(grid).size() / 2);
}

/// A group of rows in a column is an entry.
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
  return {{start, start + 2 * stride1_}, {start + stride1_, start + 3 * stride1_}};
}

/// work(thread, field, first row, where the field starts among its values) for all groups of kRows rows that
/// this rank has.
template <typename Work>
void PaddedTransform::in_groups(std::size_t values, const Work& work) {
  const Index groups = own_groups_.count();
  const Index fields = static_cast<Index>(values) / grid_.cells();
  in_parts(threads_, fields * groups, [&](int thread, Index first, Index last) {
    for (Index group = first; group < last; ++group) {
      const Index field = group / groups;
      work(thread, count(field), (own_groups_.first + group % groups) * kRows, field * grid_.cells());
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
  Complex* const spectra = halves + kRows * stride2_;
  const auto row = [&](Index i) { return i < grid_.n1 ? values + i * n2 : zero_row_.data(); };
  for (Index r = 0; r < kRows; r += 2) {
    const double* const real = row(first_row + r);
    const double* const imaginary = row(first_row + r + 1);
    Complex* const even = halves + r * stride2_;
    Complex* const odd = even + stride2_;
    for (Index j = 0; j < n2; ++j) {
      even[j] = {real[j], imaginary[j]};
      odd[j] = times(even[j], twiddle2_[count(j)]);
    }
    std::fill(even + n2, even + m2_, Complex());
    std::fill(odd + n2, odd + m2_, Complex());
    for (const Index half : {r, r + 1}) {
      execute(row_forward_, halves + half * stride2_, spectra + half * stride2_);
    }
  }
  separate(field, first_row, spectra);
}

/// The spectra X and Y of two real rows from that of x + i y: 2 X(k) = Z(k) + conj Z(-k), 2 i Y(k) = Z(k) -
/// conj Z(-k).
void PaddedTransform::separate(std::size_t field, Index first_row, const Complex* spectra) {
  constexpr double half = 0.5;
  const Index group = first_row / kRows;
  const auto separate_column = [&](Index to, Index k, Index mirrored, const Complex* pairs) {
    Complex* const out = rows_of(field, to, group);
    __builtin_prefetch(rows_of(field, std::min(to + kAhead, columns() - 1), group), 1);
    for (Index r = 0; r < kRows; r += 2) {
      const Complex z = pairs[r * stride2_ + k];
      const Complex y = pairs[r * stride2_ + mirrored];
      out[r] = {half * (z.real() + y.real()), half * (z.imag() - y.imag())};
      out[r + 1] = {half * (z.imag() + y.imag()), half * (y.real() - z.real())};
    }
  };
  const Index evens = m2_ / 2 + 1;
  separate_column(0, 0, 0, spectra);
  for (Index k = 1; k < evens; ++k) separate_column(k, k, m2_ - k, spectra);
  for (Index k = 0; evens + k < columns(); ++k) {
    separate_column(evens + k, k, m2_ - 1 - k, spectra + stride2_);
  }
}

/// The contrary of separate().
void PaddedTransform::join(std::size_t field, Index first_row, Complex* spectra) {
  const Index group = first_row / kRows;
  const auto join_column = [&](Index from, Index k, Index mirrored, Complex* pairs) {
    const Complex* const in = rows_of(field, from, group);
    __builtin_prefetch(rows_of(field, std::min(from + kAhead, columns() - 1), group));
    for (Index r = 0; r < kRows; r += 2) {
      const Complex x = in[r];
      const Complex y = in[r + 1];
      pairs[r * stride2_ + mirrored] = {x.real() + y.imag(), y.real() - x.imag()};
      pairs[r * stride2_ + k] = {x.real() - y.imag(), y.real() + x.imag()};
    }
  };
  const Index evens = m2_ / 2 + 1;
  join_column(0, 0, 0, spectra);
  for (Index k = 1; k < evens; ++k) join_column(k, k, m2_ - k, spectra);
  for (Index k = 0; evens + k < columns(); ++k) join_column(evens + k, k, m2_ - 1 - k, spectra + stride2_);
}

void PaddedTransform::backward_group(int thread, std::size_t field, Index first_row, double* values) {
  const Index n2 = grid_.n2;
  Complex* const spectra = scratch(thread);
  Complex* const halves = spectra + kRows * stride2_;
  join(field, first_row, spectra);
  for (Index r = 0; r < kRows && first_row + r < grid_.n1; r += 2) {
    for (const Index half : {r, r + 1}) {
      execute(row_backward_, spectra + half * stride2_, halves + half * stride2_);
    }
    const Complex* const even = halves + r * stride2_;
    const Complex* const odd = even + stride2_;
    double* const real = values + (first_row + r) * n2;
    const bool paired = first_row + r + 1 < grid_.n1;
    for (Index j = 0; j < n2; ++j) {
      const Complex value = even[j] + times_conjugate(odd[j], twiddle2_[count(j)]);
      real[j] = value.real();
      if (paired) real[n2 + j] = value.imag();
    }
  }
}

/// Where a column is carried: on several ranks, whose groups of rows lie apart, in a thread's memory.
auto PaddedTransform::gathered(int thread, std::size_t field, Index column_index) -> Complex* {
  if (!several_) return column(field, column_index);
  Complex* const values = padded(thread);
  shared_.each_row(reals(field), column_index, [&](Index group, const double* from) {
    __builtin_prefetch(from + kAhead * 2 * group_step_);
    std::copy_n(reinterpret_cast<const Complex*>(from), kRows, values + group * kRows);
  });
  return values;
}

void PaddedTransform::forward_column(int thread, std::size_t field, Index column_index) {
  const Spectrum spectrum = spectrum_of(thread);
  Complex* const values = gathered(thread, field, column_index);
  Complex* const odd = turned(thread);
  // A row without another to go with it leaves rounding where that would stand.
  std::fill(values + grid_.n1, values + std::max(m1_, groups() * kRows), Complex());
  for (Index i = 0; i < grid_.n1; ++i) odd[i] = times(values[i], twiddle1_[count(i)]);
  std::fill(odd + grid_.n1, odd + m1_, Complex());
  execute(column_forward_, values, spectrum.even[field]);
  execute(column_forward_, odd, spectrum.odd[field]);
}

void PaddedTransform::backward_column(int thread, std::size_t field, Index column_index) {
  const Spectrum spectrum = spectrum_of(thread);
  Complex* const even = several_ ? padded(thread) : column(field, column_index);
  Complex* const odd = turned(thread);
  execute(column_backward_, spectrum.even[field], even);
  execute(column_backward_, spectrum.odd[field], odd);
  for (Index i = 0; i < grid_.n1; ++i) even[i] += times_conjugate(odd[i], twiddle1_[count(i)]);
  std::fill(even + grid_.n1, even + groups() * kRows, Complex());  // a row without another to go with it
  if (!several_) return;
  shared_.each_row(reals(field), column_index, [&](Index group, double* to) {
    __builtin_prefetch(to + kAhead * 2 * group_step_, 1);
    std::copy_n(even + group * kRows, kRows, reinterpret_cast<Complex*>(to));
  });
}

}  // namespace slipstick::solver
