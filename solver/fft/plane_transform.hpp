#pragma once

#include "solver/fft/fftw.hpp"

namespace slipstick::solver {

/// Real fields of n1 x n2 values that are Fourier transformed in place: a workspace, the plans for it.
template <typename Real>
class PlaneTransform {
 public:
  /// planner_flags: FFTW's.
  PlaneTransform(Index n1, Index n2, Index fields, unsigned planner_flags)
      : n1_(n1), row_stride_(padded_row(n2)), buffer_(static_cast<std::size_t>(size(n1, n2, fields))) {
    const int rows = static_cast<int>(n1);
    const int numbers = static_cast<int>(row_stride_ / 2);
    const FftwPlane plane{{rows, static_cast<int>(n2)}, {rows, 2 * numbers}, {rows, numbers}};
    auto* const spectrum = buffer_.complex();
    forward_ = FftwPlan<Real>(Fftw<Real>::plan_plane_forward(plane, buffer_.data(), spectrum, planner_flags));
    backward_ =
        FftwPlan<Real>(Fftw<Real>::plan_plane_backward(plane, spectrum, buffer_.data(), planner_flags));
  }

  /// Row i of a field's n2 values, or of its n2/2 + 1 complex numbers: each its real, then its imaginary
  /// part.
  Real* row(Index field, Index i) { return buffer_.data() + (field * n1_ + i) * row_stride_; }
  void forward(Index field) { Fftw<Real>::execute(forward_.get(), row(field, 0), spectrum(field)); }
  /// n1 n2 times the inverse of forward().
  void backward(Index field) { Fftw<Real>::execute(backward_.get(), spectrum(field), row(field, 0)); }
  /// Reals from one row to the next.
  Index row_stride() const { return row_stride_; }
  std::size_t bytes() const { return buffer_.bytes(); }
  /// Reals in the workspace.
  static Index size(Index n1, Index n2, Index fields) { return fields * n1 * padded_row(n2); }

 private:
  /// An odd number of cache lines, so that a column is spread over the cache whatever its length.
  static Index padded_row(Index n2) {
    constexpr Index line = 64 / static_cast<Index>(sizeof(Real));
    const Index lines = (2 * (n2 / 2 + 1) + line - 1) / line;
    return (lines + 1 - lines % 2) * line;
  }
  typename Fftw<Real>::Complex* spectrum(Index field) {
    return reinterpret_cast<typename Fftw<Real>::Complex*>(row(field, 0));
  }

  Index n1_;
  Index row_stride_;
  FftwBuffer<Real> buffer_;
  FftwPlan<Real> forward_;
  FftwPlan<Real> backward_;
};

}  // namespace slipstick::solver
