#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "solver/fft/fftw.hpp"
#include "solver/grid/packet.hpp"

namespace slipstick::solver {

/// Cosine and sine transforms of lines of n samples at (j + 1/2), j = 0..n-1, padded with zeros: of fields
/// that are even or odd about 0, from the half of them that is stored. With half a period of h = 2 m >= 2 n
/// samples and S_k the sum over j of 2 x_j f(pi k (2 j + 1)/(2 h)),
///
///     even: f = cos, row k of the spectrum is S_k, k = 0..h-1;
///     odd:  f = sin, row k of the spectrum is S_k, k = 1..h-1, and row 0 is S_h.
///
/// kLines lines are transformed together, in pairs: one is the real part, the next the imaginary part of a
/// complex line, on which the real transforms are linear. Makhoul's reordering (IEEE Transactions on
/// Acoustics, Speech and Signal Processing 28, 1980) makes the cosine transform a Fourier transform of the
/// same length h. As half of the samples are padding, its even frequencies are one transform of length m, and
/// its odd ones another, of the samples turned by half a frequency: the padding is never transformed.
class HalfSampleTransform {
 public:
  /// One cache line to a row of the spectrum.
  static constexpr Index kLines = 64 / static_cast<Index>(sizeof(double));

  /// Where the lines lie: sample j of line l at data[place(j / kLines) + l line_stride + j % kLines], where
  /// place(i) is (i / run) run_stride + (i % run) piece_stride.
  template <typename Value>
  struct Lines {
    Value* data;
    Index line_stride;
    Index piece_stride = kLines;  ///< kLines: every line is contiguous
    Index count = kLines;         ///< lines that exist; the others are zero, and are not written
    Index run = std::numeric_limits<Index>::max();
    Index run_stride = 0;
  };

  /// Memory for one thread and one field.
  class Workspace {
   public:
    explicit Workspace(const HalfSampleTransform& transform)
        : half_(transform.half_),
          samples_(count(4 * kPairs * transform.line_stride_)),
          rows_(count(2 * half_ * kLines)) {}
    /// A spectrum's row of kLines values, one for each line.
    double* row(Index k) { return rows_.data() + ((k % 2) * half_ + k / 2) * kLines; }

   private:
    friend class HalfSampleTransform;
    Index half_;
    FftwBuffer samples_;  ///< complex lines: as they are, then turned by half a frequency
    FftwBuffer rows_;     ///< the even frequencies' rows, then the odd ones'
  };

  /// samples >= 1.
  explicit HalfSampleTransform(Index samples)
      : samples_(samples), half_(half_length(samples)), line_stride_(padded_line(half_)) {
    for (Index t = 0; t < half_; ++t) {
      const Index place = 2 * t < half_ ? t : t - half_;
      const double angle = -std::numbers::pi * static_cast<double>(place) / static_cast<double>(half_);
      const double real = std::cos(angle);
      const double imaginary = std::sin(angle);
      turn_real_.insert(turn_real_.end(), {real, real});
      turn_imaginary_.insert(turn_imaginary_.end(), {-imaginary, imaginary});
    }
    for (Index k = 0; k <= half_; ++k) {
      const double angle = -std::numbers::pi * static_cast<double>(k) / static_cast<double>(4 * half_);
      twiddle_.push_back({std::cos(angle), std::sin(angle)});
    }
    Workspace work(*this);
    const int length = static_cast<int>(half_);
    const int stride = static_cast<int>(line_stride_);
    constexpr int pairs = static_cast<int>(kPairs);
    auto* const lines = work.samples_.complex();
    auto* const rows = work.rows_.complex();
    forward_ = FftwPlan(plan_transforms({length, pairs, 1, stride, pairs, 1}, lines, rows, FFTW_FORWARD));
    backward_ = FftwPlan(plan_transforms({length, pairs, pairs, 1, 1, stride}, rows, lines, FFTW_BACKWARD));
  }

  /// h, the rows of a spectrum.
  Index frequencies() const { return 2 * half_; }
  static Index frequencies(Index samples) { return 2 * half_length(samples); }

  /// Writes row k of the lines' spectrum to target(k), which may be work.row(k). parity: +1 even, -1 odd.
  template <typename Target>
  void forward(Workspace& work, const Lines<const double>& lines, int parity, const Target& target) const {
    load(work, lines, parity);
    transform_forward(work);
    separate(work, parity, target);
  }

  /// The inverse, times 2 h. source(k)(l) is the Packet of row k that starts with line l; it may be read from
  /// work.row(k).
  template <typename Source>
  void backward(Workspace& work, const Lines<double>& lines, int parity, const Source& source) const {
    join(work, parity, source);
    transform_backward(work);
    store(work, lines, parity);
  }

  /// The packets of a row in memory, for backward().
  static auto packets(const double* row) {
    return [row](Index line) { return P::load(row + line); };
  }

 private:
  using P = Packet;
  using Vector = P::Vector;
  static constexpr Index kPairs = kLines / 2;
  static constexpr Index kNumbers = P::kSize / 2;  ///< complex numbers in a packet
  using Samples = std::array<double, static_cast<std::size_t>(P::kSize)>;

  /// One line, piece by piece of kLines samples: see Lines.
  template <typename Value>
  struct Line {
    Value* piece;
    Index stride;
    Index run = std::numeric_limits<Index>::max();
    Index run_stride = 0;
    Index of_run = 0;
    void advance() {
      piece += stride;
      if (++of_run < run) return;
      piece += run_stride - run * stride;
      of_run = 0;
    }
  };

  /// A multiple of 4, so that no packet of samples reaches over the end or from the front half into the back.
  static Index half_length(Index samples) { return 2 * fast_length((samples + 1) / 2); }
  /// A stride that is a power of two would put the same sample of all lines into the same set of the cache.
  static Index padded_line(Index half) { return half + kPairs; }

  void load(Workspace& work, const Lines<const double>& lines, int parity) const {
    static constexpr std::array<double, static_cast<std::size_t>(kLines)> kZeros{};
    const auto line = [&](Index l) -> Line<const double> {
      if (l >= lines.count) return {kZeros.data(), 0};
      return {lines.data + l * lines.line_stride, lines.piece_stride, lines.run, lines.run_stride};
    };
    for (Index pair = 0; pair < kPairs; ++pair) {
      load_pair(work.samples_.data() + 2 * pair * line_stride_, line(2 * pair), line(2 * pair + 1), parity);
    }
  }

  /// Makhoul's order: samples 0, 2, 4, ... from the front, 1, 3, 5, ... from the back.
  void load_pair(double* plain, Line<const double> first, Line<const double> second, int parity) const {
    const double sign = parity;
    Index front = 0;
    Index back = half_ - kNumbers;
    const auto put_samples = [&](const double* x, const double* y) {
      const auto [even, odd] = P::split(P::load(x), P::load(y));
      put(plain, front, even);
      put(plain, back, sign * odd);
      front += kNumbers;
      back -= kNumbers;
    };
    for (Index start = 0; start < samples_; start += kLines) {
      const Index length = std::min(kLines, samples_ - start);
      const Index whole = length / P::kSize * P::kSize;
      for (Index j = 0; j < whole; j += P::kSize) put_samples(first.piece + j, second.piece + j);
      if (whole < length) {
        Samples x{};
        Samples y{};
        std::copy(first.piece + whole, first.piece + length, x.begin());
        std::copy(second.piece + whole, second.piece + length, y.begin());
        put_samples(x.data(), y.data());
      }
      first.advance();
      second.advance();
    }
    for (; front <= back; front += kNumbers) put(plain, front, Vector{});
  }

  void store(Workspace& work, const Lines<double>& lines, int parity) const {
    std::array<double, static_cast<std::size_t>(kLines)> unwanted;
    const auto line = [&](Index l) -> Line<double> {
      if (l >= lines.count) return {unwanted.data(), 0};
      return {lines.data + l * lines.line_stride, lines.piece_stride, lines.run, lines.run_stride};
    };
    for (Index pair = 0; 2 * pair < lines.count; ++pair) {
      store_pair(work.samples_.data() + 2 * pair * line_stride_, line(2 * pair), line(2 * pair + 1), parity);
    }
  }

  void store_pair(double* plain, Line<double> first, Line<double> second, int parity) const {
    const double sign = parity;
    Index front = 0;
    Index back = half_ - kNumbers;
    const auto get_samples = [&](double* x, double* y) {
      const P::Halves samples{get(plain, front), sign * get(plain, back)};
      P::store(x, P::real_part(samples));
      P::store(y, P::imaginary_part(samples));
      front += kNumbers;
      back -= kNumbers;
    };
    for (Index start = 0; start < samples_; start += kLines) {
      const Index length = std::min(kLines, samples_ - start);
      const Index whole = length / P::kSize * P::kSize;
      for (Index j = 0; j < whole; j += P::kSize) get_samples(first.piece + j, second.piece + j);
      if (whole < length) {
        Samples x;
        Samples y;
        get_samples(x.data(), y.data());
        std::copy_n(x.data(), length - whole, first.piece + whole);
        std::copy_n(y.data(), length - whole, second.piece + whole);
      }
      first.advance();
      second.advance();
    }
  }

  /// Writes complex samples from t on to a line and to its turned copy.
  void put(double* plain, Index t, Vector z) const {
    const Vector real = P::load(&turn_real_[count(2 * t)]);
    const Vector imaginary = P::load(&turn_imaginary_[count(2 * t)]);
    P::store(plain + 2 * t, z);
    P::store(turned(plain) + 2 * t, real * z + imaginary * P::exchanged(z));
  }

  /// The sum of the inverse transforms of the two.
  Vector get(double* plain, Index t) const {
    const Vector real = P::load(&turn_real_[count(2 * t)]);
    const Vector imaginary = P::load(&turn_imaginary_[count(2 * t)]);
    const Vector z = P::load(turned(plain) + 2 * t);
    return P::load(plain + 2 * t) + (real * z - imaginary * P::exchanged(z));
  }

  double* turned(double* plain) const { return plain + 2 * kPairs * line_stride_; }

  void transform_forward(Workspace& work) const {
    for (const Index part : {0, 1}) {
      fftw_execute_dft(forward_.get(), work.samples_.complex() + part * kPairs * line_stride_,
                       work.rows_.complex() + part * kPairs * half_);
    }
  }

  void transform_backward(Workspace& work) const {
    for (const Index part : {0, 1}) {
      fftw_execute_dft(backward_.get(), work.rows_.complex() + part * kPairs * half_,
                       work.samples_.complex() + part * kPairs * line_stride_);
    }
  }

  template <typename Target>
  void separate(Workspace& work, int parity, const Target& target) const;
  template <typename Source>
  void join(Workspace& work, int parity, const Source& source) const;

  struct Twiddle {
    double c;
    double s;
  };
  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }

  Index samples_;
  Index half_;                          ///< m, a multiple of 4
  Index line_stride_;                   ///< complex numbers from one complex line to the next
  std::vector<double> turn_real_;       ///< exp(-i pi t/m), t = 0..m/2-1, -m/2..-1: its real part twice
  std::vector<double> turn_imaginary_;  ///< less its imaginary part, its imaginary part
  std::vector<Twiddle> twiddle_;        ///< exp(-i pi k/(2 h)), k = 0..m
  FftwPlan forward_;
  FftwPlan backward_;
};

/// With Z the complex Fourier transform of a reordered pair of lines and w = c + i s = exp(-i pi k/(2 h)),
/// the pair's cosine sums are
///
///     S_k     = w Z_k + conj(w) Z_(h-k)       = c (Z_k + Z_(h-k)) + i s (Z_k - Z_(h-k)),
///     S_(h-k) = i (w Z_k - conj(w) Z_(h-k))   = i c (Z_k - Z_(h-k)) - s (Z_k + Z_(h-k)).
///
/// A sine transform is a cosine transform of the samples with alternating signs, read backwards.
template <typename Target>
void HalfSampleTransform::separate(Workspace& work, int parity, const Target& target) const {
  const Index h = frequencies();
  for (Index line = 0; line < kLines; ++line) target(0)[line] = 2 * work.row(0)[line];
  for (Index k = 1; k <= half_; ++k) {
    const double* const near = work.row(k);
    const double* const far = work.row(h - k);
    const Index row = parity > 0 ? k : h - k;
    double* const low = target(row);
    double* const high = target(h - row);
    const auto [c, s] = twiddle_[at(k)];
    const Vector ic = P::alternating(-c, c);
    const Vector is = P::alternating(-s, s);
    for (Index line = 0; line < kLines; line += P::kSize) {
      const Vector sum = P::load(near + line) + P::load(far + line);
      const Vector difference = P::exchanged(P::load(near + line) - P::load(far + line));
      P::store(low + line, c * sum + is * difference);
      P::store(high + line, ic * difference - s * sum);
    }
  }
}

/// Z_k = conj(w) (S_k - i S_(h-k)) = (c S_k - s S_(h-k)) - i (s S_k + c S_(h-k)), and Z_(h-k) is the sum of
/// these terms.
template <typename Source>
void HalfSampleTransform::join(Workspace& work, int parity, const Source& source) const {
  const Index h = frequencies();
  const auto constant = source(0);
  for (Index line = 0; line < kLines; line += P::kSize) P::store(work.row(0) + line, constant(line));
  const Vector i = P::alternating(-1, 1);
  for (Index k = 1; k <= half_; ++k) {
    const Index row = parity > 0 ? k : h - k;
    const auto low = source(row);
    const auto high = source(h - row);
    double* const near = work.row(k);
    double* const far = work.row(h - k);
    const auto [c, s] = twiddle_[at(k)];
    for (Index line = 0; line < kLines; line += P::kSize) {
      const Vector a = low(line);
      const Vector b = high(line);
      const Vector real = c * a - s * b;
      const Vector imaginary = i * P::exchanged(s * a + c * b);
      P::store(near + line, real - imaginary);
      P::store(far + line, real + imaginary);
    }
  }
}

}  // namespace slipstick::solver
