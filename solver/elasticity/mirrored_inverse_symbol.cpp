#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <type_traits>

#include "solver/elasticity/inverse_symbol.hpp"
#include "solver/elasticity/symbol_table.hpp"
#include "solver/fft/periodic_transform.hpp"

namespace slipstick::solver {
namespace {

/// cos and sin of pi k1/(2 t1), and of pi k2/(2 t2) for some k2.
struct Twiddles {
  double c;
  double s;
  const double* c2;
  const double* s2;
};

/// Half a period.
Index transform_length(Index cells) { return fast_length(2 * cells) / 2; }

Grid mirrored(const Grid& grid) {
  return {2 * transform_length(grid.n1), 2 * transform_length(grid.n2), grid.h1, grid.h2};
}

/// Where sample i of t goes: even ones forwards, then odd ones backwards.
Index reordered(Index i, Index t) { return i % 2 == 0 ? i / 2 : t - 1 - i / 2; }

PeriodicTransform::Shape plane_of(const Grid& grid, bool two_fields) {
  return {transform_length(grid.n1), transform_length(grid.n2), two_fields ? 2 : 1, grid.n1, reordered, grid.ranks};
}

/// The frequencies f2 of a row of coefficients: k for cosines, then t - k for sines.
std::vector<Index> frequencies(Index t, const IndexRange& columns) {
  std::vector<Index> result;
  for (Index k = columns.first; k < columns.last; ++k) result.push_back(k);
  for (Index k = columns.first; k < columns.last; ++k) result.push_back(t - k);
  return result;
}

/// With mirror images about the diagonal p22 is the transpose of p11.
std::size_t entries_in_use(bool tangential, bool symmetric) { return tangential ? (symmetric ? 2 : 3) : 1; }

/// Values of all twiddle factors.
Index twiddle_size(Index t1, Index half) { return 2 * (t1 / 2 + 1 + half); }

/// n samples, those at even and at odd places times a sign each, padded to t.
void reorder(const double* __restrict values, Index n, double even, double odd, Index t, double* __restrict row) {
  if (n < t) std::fill_n(row, t, 0.0);
  for (Index k = 0; k < n / 2; ++k) {
    row[k] = even * values[2 * k];
    row[t - 1 - k] = odd * values[2 * k + 1];
  }
  if (n % 2 != 0) row[n / 2] = even * values[n - 1];
}

void restore(const double* __restrict row, Index n, double even, double odd, Index t, double* __restrict values) {
  for (Index k = 0; k < n / 2; ++k) {
    values[2 * k] = even * row[k];
    values[2 * k + 1] = odd * row[t - 1 - k];
  }
  if (n % 2 != 0) values[n - 1] = even * row[n / 2];
}

/// With a and b the Fourier transform at (k1, k2) and (t1 - k1, k2), w1 = exp(-i pi k1/(2 t1)) and w2 =
/// exp(-i pi k2/(2 t2)), A = w1 w2 a and B = conj(w1) w2 b are the sums over samples times
/// exp(-i (theta2 + theta1)) and exp(-i (theta2 - theta1)), with theta the arguments of the cosines. The
/// results are twice
///
///     cc = Re(A + B)/2,  cs = -Im(A + B)/2,  sc = Im(B - A)/2,  ss = Re(B - A)/2.
template <typename Count>
void separate_rows(Count count, Twiddles w, const double* __restrict a, const double* __restrict b,
                   double* __restrict cc, double* __restrict cs, double* __restrict sc, double* __restrict ss) {
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
               const double* __restrict sc, const double* __restrict ss, double* __restrict a, double* __restrict b) {
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
void mix(Count count, const double* __restrict p11, const double* __restrict p12, const double* __restrict p22,
         double* __restrict x1, double* __restrict x2) {
  for (Index k = 0; k < count; ++k) {
    const double first = x1[k];
    x1[k] = p11[k] * first + p12[k] * x2[k];
    x2[k] = p12[k] * first + p22[k] * x2[k];
  }
}

/// p11 x - p12 y, y every step-th value. At the frequency 0 p12 is zero, and there may be no y.
template <typename Count>
void mix_with_other_half(Count count, bool from_zero, const double* __restrict p11, const double* __restrict p12,
                         const double* __restrict x, const double* __restrict y, Index step, double* __restrict out) {
  if (from_zero) out[0] = p11[0] * x[0];
  for (Index k = from_zero ? 1 : 0; k < count; ++k) out[k] = p11[k] * x[k] - p12[k] * y[k * step];
}

/// work(count), which the compiler knows where the columns fill a cache line.
template <typename Work>
void with_count(Index count, const Work& work) {
  using Whole = std::integral_constant<Index, PeriodicTransform::kColumns>;
  count == Whole::value ? work(Whole()) : work(count);
}

/// The inverse symbol on a quadrant: the periodic one of the mirrored field, whose period is 2 t1 x 2 t2
/// cells, by cosine and sine transforms of the quadrant, padded with zeros to t1 x t2 cells.
///
/// 1. Samples are reordered in each direction: the even ones forwards, then the odd ones backwards. A cosine
///    transform is the Fourier transform of these times a twiddle factor (Makhoul, IEEE Transactions on
///    Acoustics, Speech and Signal Processing 28, 1980); a sine transform is the cosine transform of samples
///    with alternating signs, with t - k for the frequency k.
/// 2. PeriodicTransform: rows, then columns, in batches of kColumns.
/// 3. separate(): the coefficients at k1 and t1 - k1 by k2 and t2 - k2 follow from the Fourier transform at
///    (k1, k2) and (t1 - k1, k2).
/// 4. multiply(): the coefficients times the inverse symbol.
/// 5. join(), columns and rows backward, the order of the samples restored.
class MirroredInverseSymbol final : public InverseSymbol {
 public:
  /// With options.diagonal only the first component is transformed; the second is minus its transpose.
  MirroredInverseSymbol(const Grid& grid, bool tangential, const ElasticLaw& law, const OperatorOptions& options)
      : grid_(grid),
        tangential_(tangential),
        symmetric_(options.diagonal),
        t1_(transform_length(grid.n1)),
        t2_(transform_length(grid.n2)),
        half_(t2_ / 2 + 1),
        diagonal_(mean_inverse_symbol(mirrored(grid), law, tangential)),
        columns_(PeriodicTransform::own_columns(plane_of(grid, tangential && !symmetric_))),
        table_(mirrored(grid), law, entries_in_use(tangential, options.diagonal), frequencies(t2_, columns_),
               0.5 / (static_cast<double>(t1_) * static_cast<double>(t2_))),
        transform_(plane_of(grid, tangential && !symmetric_), options.threads),
        spectrum_(symmetric_ ? count(t1_ * transform_.row_stride()) : 0),
        twiddles_(static_cast<std::size_t>(twiddle_size(t1_, half_))) {
    fill_twiddles();
  }

  void apply(std::span<double> field) override {
    const Index cells = grid_.cells();
    if (static_cast<Index>(field.size()) != (tangential_ ? 2 : 1) * cells) {
      throw std::invalid_argument("inverse symbol applied to a field of another size");
    }
    const Index transformed = tangential_ && !symmetric_ ? 2 : 1;
    const auto samples_of = [&](Index f) { return field.data() + f * cells; };
    transform_.each_sample(transformed, [&](int t, Index f, Index i) { load(t, f, i, samples_of(f)); });
    if (symmetric_) {
      transform_.through_columns(1, 0, [&](const Columns& columns) {
        with_count(columns.count, [&](auto count) { keep_spectrum(columns, count); });
      });
      transform_.through_columns(0, 1, [&](const Columns& columns) {
        with_count(columns.count, [&](auto count) { multiply_spectrum(columns, count); });
      });
    } else {
      transform_.through_columns(transformed, transformed, [&](const Columns& columns) {
        with_count(columns.count, [&](auto count) { multiply(columns, count); });
      });
    }
    transform_.each_sample(transformed, [&](int t, Index f, Index i) { store(t, f, i, samples_of(f)); });
    if (!symmetric_) return;
    constexpr Index kBlock = 32;  // rows whose columns are read together
    in_parts(transform_.threads(), grid_.n1, [&](int, Index first, Index last) {
      for (; first < last; first += kBlock) {
        mirror_rows(field.data(), grid_.n1, {first, std::min(first + kBlock, last)});
      }
    });
  }

  std::array<double, 2> diagonal() const override { return diagonal_; }

 private:
  using Columns = PeriodicTransform::Columns;
  static constexpr Index kColumns = PeriodicTransform::kColumns;

  /// Coefficients of reordered samples in some columns, by cosines (c) of the frequency k or sines (s), which
  /// are the cosines of t - k, along x1 and x2.
  struct Coefficients {
    using Values = std::array<double, static_cast<std::size_t>(kColumns)>;
    Values cc, cs, sc, ss;
  };

  void fill_twiddles() {
    double* next = twiddles_.data();
    for (const Index t : {t1_, t2_}) {
      const double step = 0.5 * std::numbers::pi / static_cast<double>(t);
      for (Index k = 0; k <= t / 2; ++k) *next++ = std::cos(step * static_cast<double>(k));
      for (Index k = 0; k <= t / 2; ++k) *next++ = std::sin(step * static_cast<double>(k));
    }
  }

  /// Factors of the samples at even and at odd places of row i: q1 is odd in x2 and q2 in x1.
  std::array<double, 2> signs(Index f, Index i) const {
    if (!tangential_) return {1, 1};
    if (f == 0) return {1, -1};
    const double sign = i % 2 == 0 ? 1.0 : -1.0;
    return {sign, sign};
  }

  void load(int thread, Index f, Index i, const double* values) {
    const auto [even, odd] = signs(f, i);
    reorder(values + i * grid_.n2, grid_.n2, even, odd, t2_, transform_.own_row(thread));
    transform_.forward_sample(transform_.own_row(thread), f, i);
  }

  void store(int thread, Index f, Index i, double* values) {
    const auto [even, odd] = signs(f, i);
    transform_.backward_sample(transform_.own_row(thread), f, i);
    restore(transform_.own_row(thread), grid_.n2, even, odd, t2_, values + i * grid_.n2);
  }

  /// cos and sin at row k1 and in some columns.
  Twiddles twiddles(Index k1, Index first_column) const {
    const double* const c1 = twiddles_.data();
    const double* const c2 = c1 + 2 * (t1_ / 2 + 1) + first_column;
    return {c1[k1], c1[t1_ / 2 + 1 + k1], c2, c2 + half_};
  }

  // In some columns. count: their number, known to the compiler where they fill a cache line.
  template <typename Count>
  void separate(const Columns& columns, Count count, Index f, Index k1, Coefficients& to) const {
    separate_rows(count, twiddles(k1, columns.first), columns.row(f, k1), columns.row(f, k1 == 0 ? 0 : t1_ - k1),
                  to.cc.data(), to.cs.data(), to.sc.data(), to.ss.data());
  }

  /// Rows 0 and t1/2 are their own partners, so that only one of two results is kept.
  template <typename Count>
  void join(const Coefficients& from, const Columns& columns, Count count, Index f, Index k1) const {
    std::array<double, static_cast<std::size_t>(2 * kColumns)> dummy_row;
    const bool own_partner = k1 == 0 || 2 * k1 == t1_;
    join_rows(count, twiddles(k1, columns.first), from.cc.data(), from.cs.data(), from.sc.data(), from.ss.data(),
              columns.row(f, k1), own_partner ? dummy_row.data() : columns.row(f, t1_ - k1));
  }

  template <typename Count>
  void multiply(const Columns& columns, Count count) const {
    const Index fields = tangential_ ? 2 : 1;
    std::array<Coefficients, 2> x;
    for (Index k1 = 0; k1 <= t1_ / 2; ++k1) {
      for (Index f = 0; f < fields; ++f) separate(columns, count, f, k1, x[static_cast<std::size_t>(f)]);
      multiply_rows(x, columns, count, k1);
      for (Index f = 0; f < fields; ++f) join(x[static_cast<std::size_t>(f)], columns, count, f, k1);
    }
  }

  /// q1 is odd in x2 and q2 in x1. Cosines have the frequency k, sines t - k, and alternating signs make that
  /// k again: so cs of q1 belongs to the same frequencies as sc of q2, and so on.
  template <typename Count>
  void multiply_rows(std::array<Coefficients, 2>& fields, const Columns& columns, Count count, Index k1) const {
    const Index first = columns.first - columns_.first;
    const Index sines = first + columns_.count();
    auto& [x, y] = fields;
    if (!tangential_) {
      const double* const low = table_.row(SymbolEntry::p11, k1);
      const double* const high = table_.row(SymbolEntry::p11, t1_ - k1);
      scale(count, low + first, x.cc.data());
      scale(count, low + sines, x.cs.data());
      scale(count, high + first, x.sc.data());
      scale(count, high + sines, x.ss.data());
      return;
    }
    const auto mix_at = [&](Index f1, Index column, auto& x1, auto& x2) {
      mix(count, table_.row(SymbolEntry::p11, f1) + column, table_.row(SymbolEntry::p12, f1) + column,
          table_.row(SymbolEntry::p22, f1) + column, x1.data(), x2.data());
    };
    mix_at(k1, first, x.cs, y.sc);
    mix_at(k1, sines, x.cc, y.ss);
    mix_at(t1_ - k1, first, x.ss, y.cc);
    mix_at(t1_ - k1, sines, x.sc, y.cs);
  }

  // For a mirror at the diagonal: forward into spectrum_, and back from there.
  /// A coefficient of q2 at (f1, f2) is minus q1's at (f2, f1), so that all of q1's are stored first.
  template <typename Count>
  void keep_spectrum(const Columns& columns, Count count) {
    const auto keep = [&](const Coefficients::Values& low, const Coefficients::Values& high, Index k1) {
      double* const row = spectrum_.data() + k1 * transform_.row_stride() + columns.first;
      std::copy_n(low.begin(), static_cast<Index>(count), row);
      std::copy_n(high.begin(), static_cast<Index>(count), row + half_);
    };
    Coefficients x;
    for (Index k1 = 0; k1 <= t1_ / 2; ++k1) {
      separate(columns, count, 0, k1, x);
      keep(x.cs, x.cc, k1);
      if (k1 != 0 && 2 * k1 != t1_) keep(x.ss, x.sc, t1_ - k1);
    }
  }

  /// Rows and columns of spectrum_ hold the frequencies k, then t - k (rows: at t1 - k).
  template <typename Count>
  void multiply_spectrum(const Columns& columns, Count count) const {
    const Index first = columns.first;
    const Index stride = transform_.row_stride();
    const auto mix_row = [&](Index f1, bool sines, Index other_column, Coefficients::Values& out) {
      const Index column = first + (sines ? half_ : 0);
      const Index step = sines ? -stride : stride;
      const double* const other = spectrum(sines ? t1_ : 0) + other_column + first * step;
      mix_with_other_half(count, first == 0, table_.row(SymbolEntry::p11, f1) + column,
                          table_.row(SymbolEntry::p12, f1) + column, spectrum(f1) + column, other, step, out.data());
    };
    Coefficients to{};
    for (Index k1 = 0; k1 <= t1_ / 2; ++k1) {
      mix_row(k1, false, k1, to.cs);
      mix_row(k1, true, k1, to.cc);
      if (k1 > 0) {  // q1 is even in x1: no frequency t1
        mix_row(t1_ - k1, false, half_ + k1, to.ss);
        mix_row(t1_ - k1, true, half_ + k1, to.sc);
      }
      join(to, columns, count, 0, k1);
    }
  }

  const double* spectrum(Index k1) const { return spectrum_.data() + k1 * transform_.row_stride(); }

  Grid grid_;
  bool tangential_;
  bool symmetric_;
  Index t1_;
  Index t2_;
  Index half_;  ///< t2/2 + 1
  std::array<double, 2> diagonal_;
  IndexRange columns_;  ///< of this rank, of 0..t2/2
  SymbolTable table_;   ///< those frequencies, then t2 less each of them
  PeriodicTransform transform_;
  FftwBuffer spectrum_;  ///< symmetric fields only: t1 rows, frequencies k2, then t2 - k2
  FftwBuffer twiddles_;  ///< cos and sin of pi k/(2 t1), k = 0..t1/2, then of pi k/(2 t2)
};

}  // namespace

std::unique_ptr<InverseSymbol> make_mirrored_inverse_symbol(const Grid& grid, bool tangential, const ElasticLaw& law,
                                                            const OperatorOptions& options) {
  return std::make_unique<MirroredInverseSymbol>(grid, tangential, law, options);
}

}  // namespace slipstick::solver
