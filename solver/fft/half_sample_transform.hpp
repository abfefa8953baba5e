#pragma once

#include <array>
#include <limits>
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
    explicit Workspace(const HalfSampleTransform& transform);
    /// A spectrum's row of kLines values, one for each line.
    double* row(Index k) { return rows_.data() + ((k % 2) * half_ + k / 2) * kLines; }

   private:
    friend class HalfSampleTransform;
    Index half_;
    FftwBuffer samples_;  ///< complex lines: as they are, then turned by half a frequency
    FftwBuffer rows_;     ///< the even frequencies' rows, then the odd ones'
  };

  /// samples >= 1.
  explicit HalfSampleTransform(Index samples);

  /// h, the rows of a spectrum.
  Index frequencies() const { return 2 * half_; }
  static Index frequencies(Index samples);

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

  static Index half_length(Index samples);
  static Index padded_line(Index half);
  void load(Workspace& work, const Lines<const double>& lines, int parity) const;
  void load_pair(double* plain, Line<const double> first, Line<const double> second, int parity) const;
  void store(Workspace& work, const Lines<double>& lines, int parity) const;
  void store_pair(double* plain, Line<double> first, Line<double> second, int parity) const;
  /// Writes complex samples from t on to a line and to its turned copy.
  void put(double* plain, Index t, Vector z) const;
  /// The sum of the inverse transforms of the two.
  Vector get(double* plain, Index t) const;
  double* turned(double* plain) const { return plain + 2 * kPairs * line_stride_; }
  void transform_forward(Workspace& work) const;
  void transform_backward(Workspace& work) const;
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
