#include "solver/elasticity/mirrored_inverse_symbol.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <type_traits>

namespace slipstick::solver {
namespace {

/// Half a period.
Index transform_length(Index cells) { return fast_length(2 * cells) / 2; }

Grid mirrored(const Grid& grid) {
  return {2 * transform_length(grid.n1), 2 * transform_length(grid.n2), grid.h1, grid.h2};
}

/// Where sample i of t goes: even ones forwards, then odd ones backwards.
Index reordered(Index i, Index t) { return i % 2 == 0 ? i / 2 : t - 1 - i / 2; }

PlaneShape plane_of(const Grid& grid, bool tangential, bool symmetric) {
  return {transform_length(grid.n1),
          transform_length(grid.n2),
          tangential ? 2 : 1,
          grid.n1,
          reordered,
          symmetric,
          grid.ranks};
}

/// Where frequencies f2 lie in a row of coefficients: those of cosines, then those of sines.
std::vector<Index> frequencies(Index t, const IndexRange& columns) {
  std::vector<Index> result;
  for (Index k = columns.first; k < columns.last; ++k) result.push_back(k);
  for (Index k = columns.first; k < columns.last; ++k) result.push_back(t - k);
  return result;
}

/// With mirror images about the diagonal p22 is the transpose of p11.
std::size_t entries_in_use(bool tangential, bool symmetric) { return tangential ? (symmetric ? 2 : 3) : 1; }

/// Values in the scratch memory, four coefficients for each field and a complex row, and of all twiddle
/// factors.
Index coefficient_size(Index half, bool two_fields) { return (two_fields ? 10 : 6) * half; }
Index twiddle_size(Index t1, Index half) { return 2 * (t1 / 2 + 1 + half); }

/// n samples, those at even and at odd places times a sign each, padded to t.
void reorder(const double* __restrict values, Index n, double even, double odd, Index t,
             double* __restrict row) {
  if (n < t) std::fill_n(row, t, 0.0);
  for (Index k = 0; k < n / 2; ++k) {
    row[k] = even * values[2 * k];
    row[t - 1 - k] = odd * values[2 * k + 1];
  }
  if (n % 2 != 0) row[n / 2] = even * values[n - 1];
}

void restore(const double* __restrict row, Index n, double even, double odd, Index t,
             double* __restrict values) {
  for (Index k = 0; k < n / 2; ++k) {
    values[2 * k] = even * row[k];
    values[2 * k + 1] = odd * row[t - 1 - k];
  }
  if (n % 2 != 0) values[n - 1] = even * row[n / 2];
}

/// With a and b the Fourier transform at (k1, k2) and (t1 - k1, k2), w1 = exp(-i pi k1/(2 t1)) and w2
/// likewise, A = w1 w2 a and B = conj(w1) w2 b are the sums over samples times exp(-i (theta2 + theta1)) and
/// exp(-i (theta2 - theta1)), theta the arguments of the cosines. Written is twice
///
///     cc = Re(A + B)/2,  cs = -Im(A + B)/2,  sc = Im(B - A)/2,  ss = Re(B - A)/2.
template <typename Count>
void separate_rows(Count count, Twiddles w, const double* __restrict a, const double* __restrict b,
                   double* __restrict cc, double* __restrict cs, double* __restrict sc,
                   double* __restrict ss) {
  for (Index k = 0; k < count; ++k) {
    const double sum_real = a[2 * k] + b[2 * k];
    const double sum_imaginary = a[2 * k + 1] + b[2 * k + 1];
    const double difference_real = a[2 * k] - b[2 * k];
    const double difference_imaginary = a[2 * k + 1] - b[2 * k + 1];
    const double sr = w.c2[k] * sum_real + w.s2[k] * sum_imaginary;
    const double si = w.c2[k] * sum_imaginary - w.s2[k] * sum_real;
    const double dr = w.c2[k] * difference_real + w.s2[k] * difference_imaginary;
    const double di = w.c2[k] * difference_imaginary - w.s2[k] * difference_real;
    cc[k] = w.c * sr + w.s * di;
    cs[k] = w.s * dr - w.c * si;
    sc[k] = w.s * sr - w.c * di;
    ss[k] = -w.c * dr - w.s * si;
  }
}

/// The inverse of separate_rows(), times 2.
template <typename Count>
void join_rows(Count count, Twiddles w, const double* __restrict cc, const double* __restrict cs,
               const double* __restrict sc, const double* __restrict ss, double* __restrict a,
               double* __restrict b) {
  for (Index k = 0; k < count; ++k) {
    const double sr = w.c * cc[k] + w.s * sc[k];
    const double si = -w.c * cs[k] - w.s * ss[k];
    const double dr = w.s * cs[k] - w.c * ss[k];
    const double di = w.s * cc[k] - w.c * sc[k];
    const double sum_real = w.c2[k] * sr - w.s2[k] * si;
    const double sum_imaginary = w.c2[k] * si + w.s2[k] * sr;
    const double difference_real = w.c2[k] * dr - w.s2[k] * di;
    const double difference_imaginary = w.c2[k] * di + w.s2[k] * dr;
    a[2 * k] = sum_real + difference_real;
    a[2 * k + 1] = sum_imaginary + difference_imaginary;
    b[2 * k] = sum_real - difference_real;
    b[2 * k + 1] = sum_imaginary - difference_imaginary;
  }
}

template <typename Count>
void scale(Count count, const double* __restrict p, double* __restrict x) {
  for (Index k = 0; k < count; ++k) x[k] *= p[k];
}

template <typename Count>
void mix(Count count, const double* __restrict p11, const double* __restrict p12,
         const double* __restrict p22, double* __restrict x1, double* __restrict x2) {
  for (Index k = 0; k < count; ++k) {
    const double first = x1[k];
    x1[k] = p11[k] * first + p12[k] * x2[k];
    x2[k] = p12[k] * first + p22[k] * x2[k];
  }
}

/// p11 x - p12 y, y every step-th value. The first p12 is zero, and there need be no first y.
void mix_with_other_half(Index count, const double* __restrict p11, const double* __restrict p12,
                         const double* __restrict x, const double* __restrict y, Index step,
                         double* __restrict out) {
  out[0] = p11[0] * x[0];
  for (Index k = 1; k < count; ++k) out[k] = p11[k] * x[k] - p12[k] * y[k * step];
}

}  // namespace

MirroredInverseSymbol::MirroredInverseSymbol(const Grid& grid, bool tangential, const ElasticLaw& law,
                                             const OperatorOptions& options)
    : grid_(grid),
      tangential_(tangential),
      symmetric_(options.diagonal),
      t1_(transform_length(grid.n1)),
      t2_(transform_length(grid.n2)),
      half_(t2_ / 2 + 1),
      diagonal_(mean_inverse_symbol(mirrored(grid), law, tangential)),
      columns_(PlaneTransform::own_columns(plane_of(grid, tangential, symmetric_))),
      table_(mirrored(grid), law, entries_in_use(tangential, options.diagonal), frequencies(t2_, columns_),
             0.5 / (static_cast<double>(t1_) * static_cast<double>(t2_))),
      transform_(plane_of(grid, tangential, symmetric_), options.threads),
      scratch_(coefficient_size(half_, tangential_ && !symmetric_)),
      coefficients_(static_cast<std::size_t>(options.threads * scratch_)),
      twiddles_(static_cast<std::size_t>(twiddle_size(t1_, half_))) {
  fill_twiddles();
}

void MirroredInverseSymbol::fill_twiddles() {
  double* next = twiddles_.data();
  for (const Index t : {t1_, t2_}) {
    const double step = 0.5 * std::numbers::pi / static_cast<double>(t);
    for (Index k = 0; k <= t / 2; ++k) *next++ = std::cos(step * static_cast<double>(k));
    for (Index k = 0; k <= t / 2; ++k) *next++ = std::sin(step * static_cast<double>(k));
  }
}

void MirroredInverseSymbol::apply(std::span<double> field) {
  const Index cells = grid_.cells();
  if (static_cast<Index>(field.size()) != (tangential_ ? 2 : 1) * cells) {
    throw std::invalid_argument("inverse symbol applied to a field of another size");
  }
  const Index transformed = tangential_ && !symmetric_ ? 2 : 1;
  const int threads = transform_.threads();
  const IndexRange own = transform_.own_samples();
  const auto each_row = [&](const auto& work) {
    in_parts(threads, transformed * own.count(), [&](int thread, Index first, Index last) {
      for (Index i = first; i < last; ++i) work(thread, i / own.count(), own.first + i % own.count());
    });
  };
  each_row([&](int thread, Index f, Index i) { load(thread, f, i, field.data() + f * cells); });
  if (symmetric_) {
    transform_.clear_others(0);
    transform_.forward_columns(0);
    multiply_symmetric();
    transform_.backward_columns(1);
  } else {
    transform_.through_columns(transformed, [&](int thread, const PlaneColumns& columns) {
      using Whole = std::integral_constant<Index, PlaneTransform::kColumns>;
      columns.count == Whole::value ? multiply(thread, columns, Whole())
                                    : multiply(thread, columns, columns.count);
    });
  }
  const Index result = symmetric_ ? 1 : 0;
  each_row([&](int thread, Index f, Index i) { store(thread, result + f, i, field.data() + f * cells); });
  if (!symmetric_) return;
  in_parts(threads, grid_.n1,
           [&](int, Index first, Index last) { store_transposed(field.data(), first, last); });
}

/// Sample i of a field, and forward.
void MirroredInverseSymbol::load(int thread, Index f, Index i, const double* values) {
  const auto [even, odd] = signs(f, i);
  reorder(values + i * grid_.n2, grid_.n2, even, odd, t2_, transform_.own_row(thread));
  transform_.forward_sample(transform_.own_row(thread), f, i);
}

void MirroredInverseSymbol::store(int thread, Index f, Index i, double* values) {
  const auto [even, odd] = signs(symmetric_ ? 0 : f, i);
  transform_.backward_sample(transform_.own_row(thread), f, i);
  restore(transform_.own_row(thread), grid_.n2, even, odd, t2_, values + i * grid_.n2);
}

/// q1 is odd in x2 and q2 in x1: their samples at odd places take the other sign there.
std::array<double, 2> MirroredInverseSymbol::signs(Index f, Index i) const {
  if (!tangential_) return {1, 1};
  if (f == 0) return {1, -1};
  const double sign = i % 2 == 0 ? 1.0 : -1.0;
  return {sign, sign};
}

auto MirroredInverseSymbol::coefficients(int thread, Index f) -> Coefficients {
  double* const first = scratch(thread) + 4 * f * half_;
  return {first, first + half_, first + 2 * half_, first + 3 * half_};
}

/// cos and sin at row k1 and in some columns.
Twiddles MirroredInverseSymbol::twiddles(Index k1, Index first_column) const {
  const double* const c1 = twiddles_.data();
  const double* const c2 = c1 + 2 * (t1_ / 2 + 1) + first_column;
  return {c1[k1], c1[t1_ / 2 + 1 + k1], c2, c2 + half_};
}

template <typename Count>
void MirroredInverseSymbol::separate(int thread, const PlaneColumns& columns, Count count, Index f,
                                     Index k1) {
  const Coefficients to = coefficients(thread, f);
  separate_rows(count, twiddles(k1, columns.first), columns.row(f, k1),
                columns.row(f, k1 == 0 ? 0 : t1_ - k1), to.cc, to.cs, to.sc, to.ss);
}

template <typename Count>
void MirroredInverseSymbol::join(int thread, const Coefficients& from, const PlaneColumns& columns,
                                 Count count, Index f, Index k1) {
  // Rows 0 and t1/2 are their own partners: what is written twice goes elsewhere once.
  const bool alone = k1 == 0 || 2 * k1 == t1_;
  double* const unused = scratch(thread) + scratch_ - 2 * half_;
  join_rows(count, twiddles(k1, columns.first), from.cc, from.cs, from.sc, from.ss, columns.row(f, k1),
            alone ? unused : columns.row(f, t1_ - k1));
}

template <typename Work>
void MirroredInverseSymbol::for_row_pairs(const Work& work) {
  in_parts(transform_.threads(), t1_ / 2 + 1, [&](int thread, Index first, Index last) {
    for (Index k1 = first; k1 < last; ++k1) work(thread, k1);
  });
}

template <typename Count>
void MirroredInverseSymbol::multiply(int thread, const PlaneColumns& columns, Count count) {
  const Index fields = tangential_ ? 2 : 1;
  for (Index k1 = 0; k1 <= t1_ / 2; ++k1) {
    for (Index f = 0; f < fields; ++f) separate(thread, columns, count, f, k1);
    multiply_rows(thread, columns, count, k1);
    for (Index f = 0; f < fields; ++f) join(thread, coefficients(thread, f), columns, count, f, k1);
  }
}

/// Cosines of the frequencies k of p; sines of t - k, which for the odd coordinate of q1 and of q2 is k: so
/// q1's cs has the frequencies of q2's sc, and so on.
template <typename Count>
void MirroredInverseSymbol::multiply_rows(int thread, const PlaneColumns& columns, Count count, Index k1) {
  const Index first = columns.first - columns_.first;
  const auto low = [&](SymbolEntry entry) { return table_.row(entry, k1) + first; };
  const auto high = [&](SymbolEntry entry) { return table_.row(entry, t1_ - k1) + first; };
  const Index sines = columns_.count();
  const Coefficients x = coefficients(thread, 0);
  if (!tangential_) {
    scale(count, low(SymbolEntry::p11), x.cc);
    scale(count, low(SymbolEntry::p11) + sines, x.cs);
    scale(count, high(SymbolEntry::p11), x.sc);
    scale(count, high(SymbolEntry::p11) + sines, x.ss);
    return;
  }
  const auto multiply_pair = [&](const auto& row, Index column, double* x1, double* x2) {
    mix(count, row(SymbolEntry::p11) + column, row(SymbolEntry::p12) + column, row(SymbolEntry::p22) + column,
        x1, x2);
  };
  const Coefficients y = coefficients(thread, 1);
  multiply_pair(low, 0, x.cs, y.sc);
  multiply_pair(low, sines, x.cc, y.ss);
  multiply_pair(high, 0, x.ss, y.cc);
  multiply_pair(high, sines, x.sc, y.cs);
}

/// The coefficients of q2 at (f1, f2) are minus those of q1 at (f2, f1): all of those are made first, in
/// place of the transform.
void MirroredInverseSymbol::multiply_symmetric() {
  for_row_pairs([&](int thread, Index k1) {
    const Coefficients x = coefficients(thread, 0);
    separate(thread, transform_.all_columns(), half_, 0, k1);
    double* const low = transform_.row(0, k1);
    std::copy_n(x.cs, half_, low);
    std::copy_n(x.cc, half_, low + half_);
    if (k1 == 0 || 2 * k1 == t1_) return;
    double* const high = transform_.row(0, t1_ - k1);
    std::copy_n(x.ss, half_, high);
    std::copy_n(x.sc, half_, high + half_);
  });
  for_row_pairs([&](int thread, Index k1) {
    multiply_symmetric_rows(thread, k1);
    join(thread, coefficients(thread, 0), transform_.all_columns(), half_, 1, k1);
  });
}

/// Rows and columns hold the frequencies k, and t - k after them (rows: before the end).
void MirroredInverseSymbol::multiply_symmetric_rows(int thread, Index k1) {
  const Coefficients to = coefficients(thread, 0);
  const Index step = transform_.row_stride();
  const auto mix_row = [&](Index f1, Index column, Index other_column, double* out) {
    const double* const other =
        column == 0 ? transform_.row(0, 0) + other_column : transform_.row(0, t1_) + other_column;
    mix_with_other_half(half_, table_.row(SymbolEntry::p11, f1) + column,
                        table_.row(SymbolEntry::p12, f1) + column, transform_.row(0, f1) + column, other,
                        column == 0 ? step : -step, out);
  };
  mix_row(k1, 0, k1, to.cs);
  mix_row(k1, half_, k1, to.cc);
  if (k1 == 0) {  // no frequency t1 along x1, in which q1 is even
    std::fill_n(to.ss, half_, 0.0);
    std::fill_n(to.sc, half_, 0.0);
    return;
  }
  mix_row(t1_ - k1, 0, half_ + k1, to.ss);
  mix_row(t1_ - k1, half_, half_ + k1, to.sc);
}

/// The second component, from these rows of the first.
void MirroredInverseSymbol::store_transposed(double* field, Index first_row, Index last_row) const {
  constexpr Index kBlock = 32;  // rows whose columns are read together, while they are in cache
  const Index n = grid_.n1;
  double* const second = field + grid_.cells();
  for (Index first = first_row; first < last_row; first += kBlock) {
    const Index last = std::min(first + kBlock, last_row);
    for (Index j = 0; j < n; ++j) {
      for (Index i = first; i < last; ++i) second[j * n + i] = -field[i * n + j];
    }
  }
}

}  // namespace slipstick::solver
