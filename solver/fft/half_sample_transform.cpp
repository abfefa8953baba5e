#include "solver/fft/half_sample_transform.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace slipstick::solver {
namespace {

constexpr double kPi = std::numbers::pi;

}  // namespace

/// A multiple of 4, so that no packet of samples reaches over the end or from the front half into the back.
Index HalfSampleTransform::half_length(Index samples) { return 2 * fast_length((samples + 1) / 2); }

/// A stride that is a power of two would put the same sample of all lines into the same set of the cache.
Index HalfSampleTransform::padded_line(Index half) { return half + kPairs; }

Index HalfSampleTransform::frequencies(Index samples) { return 2 * half_length(samples); }

HalfSampleTransform::Workspace::Workspace(const HalfSampleTransform& transform)
    : half_(transform.half_),
      samples_(count(4 * kPairs * transform.line_stride_)),
      rows_(count(2 * half_ * kLines)) {}

HalfSampleTransform::HalfSampleTransform(Index samples)
    : samples_(samples), half_(half_length(samples)), line_stride_(padded_line(half_)) {
  for (Index t = 0; t < half_; ++t) {
    const Index place = 2 * t < half_ ? t : t - half_;
    const double angle = -kPi * static_cast<double>(place) / static_cast<double>(half_);
    const double real = std::cos(angle);
    const double imaginary = std::sin(angle);
    turn_real_.insert(turn_real_.end(), {real, real});
    turn_imaginary_.insert(turn_imaginary_.end(), {-imaginary, imaginary});
  }
  for (Index k = 0; k <= half_; ++k) {
    const double angle = -kPi * static_cast<double>(k) / static_cast<double>(4 * half_);
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

void HalfSampleTransform::load(Workspace& work, const Lines<const double>& lines, int parity) const {
  static constexpr std::array<double, static_cast<std::size_t>(kLines)> kZeros{};
  const auto line = [&](Index l) -> Line<const double> {
    if (l >= lines.count) return {kZeros.data(), 0};
    return {lines.data + l * lines.line_stride, lines.piece_stride, lines.run, lines.run_stride};
  };
  for (Index pair = 0; pair < kPairs; ++pair) {
    load_pair(work.samples_.data() + 2 * pair * line_stride_, line(2 * pair), line(2 * pair + 1), parity);
  }
}

inline void HalfSampleTransform::put(double* plain, Index t, Vector z) const {
  const Vector real = P::load(&turn_real_[count(2 * t)]);
  const Vector imaginary = P::load(&turn_imaginary_[count(2 * t)]);
  P::store(plain + 2 * t, z);
  P::store(turned(plain) + 2 * t, real * z + imaginary * P::exchanged(z));
}

inline auto HalfSampleTransform::get(double* plain, Index t) const -> Vector {
  const Vector real = P::load(&turn_real_[count(2 * t)]);
  const Vector imaginary = P::load(&turn_imaginary_[count(2 * t)]);
  const Vector z = P::load(turned(plain) + 2 * t);
  return P::load(plain + 2 * t) + (real * z - imaginary * P::exchanged(z));
}

/// Makhoul's order: samples 0, 2, 4, ... from the front, 1, 3, 5, ... from the back.
void HalfSampleTransform::load_pair(double* plain, Line<const double> first, Line<const double> second,
                                    int parity) const {
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

void HalfSampleTransform::store(Workspace& work, const Lines<double>& lines, int parity) const {
  std::array<double, static_cast<std::size_t>(kLines)> unwanted;
  const auto line = [&](Index l) -> Line<double> {
    if (l >= lines.count) return {unwanted.data(), 0};
    return {lines.data + l * lines.line_stride, lines.piece_stride, lines.run, lines.run_stride};
  };
  for (Index pair = 0; 2 * pair < lines.count; ++pair) {
    store_pair(work.samples_.data() + 2 * pair * line_stride_, line(2 * pair), line(2 * pair + 1), parity);
  }
}

void HalfSampleTransform::store_pair(double* plain, Line<double> first, Line<double> second,
                                     int parity) const {
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

void HalfSampleTransform::transform_forward(Workspace& work) const {
  for (const Index part : {0, 1}) {
    fftw_execute_dft(forward_.get(), work.samples_.complex() + part * kPairs * line_stride_,
                     work.rows_.complex() + part * kPairs * half_);
  }
}

void HalfSampleTransform::transform_backward(Workspace& work) const {
  for (const Index part : {0, 1}) {
    fftw_execute_dft(backward_.get(), work.rows_.complex() + part * kPairs * half_,
                     work.samples_.complex() + part * kPairs * line_stride_);
  }
}

}  // namespace slipstick::solver
