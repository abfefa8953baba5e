#pragma once

#include <fftw3.h>

#include <algorithm>
#include <array>
#include <memory>
#include <new>
#include <stdexcept>
#include <type_traits>

#include "solver/grid/grid.hpp"

/// FFTW's C interface, owned and by precision. Plans are estimated: those that are measured give other bits
/// from run to run.
namespace slipstick::solver {

/// As containers count.
inline std::size_t count(Index n) { return static_cast<std::size_t>(n); }

/// Complex lines that are transformed by one plan: from one value of a line to its next, and from one line to
/// the next, where they are read and where they are written.
struct FftwLines {
  int length;
  int count;
  int in_step;
  int in_distance;
  int out_step;
  int out_distance;
};

/// A real field of two dimensions and its Fourier transform: their lengths, and the rows and columns of the
/// arrays that hold the real values and the complex numbers.
struct FftwPlane {
  std::array<int, 2> lengths;
  std::array<int, 2> reals;
  std::array<int, 2> numbers;
};

template <typename Real>
struct Fftw;

template <>
struct Fftw<double> {
  using Complex = fftw_complex;
  using Plan = fftw_plan;
  static double* allocate(std::size_t count) { return fftw_alloc_real(count); }
  static void free(double* pointer) { fftw_free(pointer); }
  static Plan plan(int length, Complex* in, Complex* out, int direction) {
    return fftw_plan_dft_1d(length, in, out, direction, FFTW_ESTIMATE);
  }
  static void execute(Plan plan, Complex* in, Complex* out) { fftw_execute_dft(plan, in, out); }
  static void destroy(Plan plan) { fftw_destroy_plan(plan); }

  static Plan plan_lines(const FftwLines& lines, Complex* in, Complex* out, int sign) {
    return fftw_plan_many_dft(1, &lines.length, lines.count, in, nullptr, lines.in_step, lines.in_distance,
                              out, nullptr, lines.out_step, lines.out_distance, sign, FFTW_ESTIMATE);
  }
  static Plan plan_plane_forward(const FftwPlane& plane, double* in, Complex* out) {
    return fftw_plan_many_dft_r2c(2, plane.lengths.data(), 1, in, plane.reals.data(), 1, 0, out,
                                  plane.numbers.data(), 1, 0, FFTW_ESTIMATE);
  }
  static Plan plan_plane_backward(const FftwPlane& plane, Complex* in, double* out) {
    return fftw_plan_many_dft_c2r(2, plane.lengths.data(), 1, in, plane.numbers.data(), 1, 0, out,
                                  plane.reals.data(), 1, 0, FFTW_ESTIMATE);
  }
  static Plan plan_row_forward(int length, double* in, Complex* out) {
    return fftw_plan_many_dft_r2c(1, &length, 1, in, nullptr, 1, 0, out, nullptr, 1, 0, FFTW_ESTIMATE);
  }
  static Plan plan_row_backward(int length, Complex* in, double* out) {
    return fftw_plan_many_dft_c2r(1, &length, 1, in, nullptr, 1, 0, out, nullptr, 1, 0, FFTW_ESTIMATE);
  }
  static void execute(Plan plan, double* in, Complex* out) { fftw_execute_dft_r2c(plan, in, out); }
  static void execute(Plan plan, Complex* in, double* out) { fftw_execute_dft_c2r(plan, in, out); }
};

template <>
struct Fftw<float> {
  using Complex = fftwf_complex;
  using Plan = fftwf_plan;
  static float* allocate(std::size_t count) { return fftwf_alloc_real(count); }
  static void free(float* pointer) { fftwf_free(pointer); }
  static Plan plan(int length, Complex* in, Complex* out, int direction) {
    return fftwf_plan_dft_1d(length, in, out, direction, FFTW_ESTIMATE);
  }
  static void execute(Plan plan, Complex* in, Complex* out) { fftwf_execute_dft(plan, in, out); }
  static void destroy(Plan plan) { fftwf_destroy_plan(plan); }

  static Plan plan_lines(const FftwLines& lines, Complex* in, Complex* out, int sign) {
    return fftwf_plan_many_dft(1, &lines.length, lines.count, in, nullptr, lines.in_step, lines.in_distance,
                               out, nullptr, lines.out_step, lines.out_distance, sign, FFTW_ESTIMATE);
  }
  static Plan plan_plane_forward(const FftwPlane& plane, float* in, Complex* out) {
    return fftwf_plan_many_dft_r2c(2, plane.lengths.data(), 1, in, plane.reals.data(), 1, 0, out,
                                   plane.numbers.data(), 1, 0, FFTW_ESTIMATE);
  }
  static Plan plan_plane_backward(const FftwPlane& plane, Complex* in, float* out) {
    return fftwf_plan_many_dft_c2r(2, plane.lengths.data(), 1, in, plane.numbers.data(), 1, 0, out,
                                   plane.reals.data(), 1, 0, FFTW_ESTIMATE);
  }
  static Plan plan_row_forward(int length, float* in, Complex* out) {
    return fftwf_plan_many_dft_r2c(1, &length, 1, in, nullptr, 1, 0, out, nullptr, 1, 0, FFTW_ESTIMATE);
  }
  static Plan plan_row_backward(int length, Complex* in, float* out) {
    return fftwf_plan_many_dft_c2r(1, &length, 1, in, nullptr, 1, 0, out, nullptr, 1, 0, FFTW_ESTIMATE);
  }
  static void execute(Plan plan, float* in, Complex* out) { fftwf_execute_dft_r2c(plan, in, out); }
  static void execute(Plan plan, Complex* in, float* out) { fftwf_execute_dft_c2r(plan, in, out); }
};

/// Zeroed memory, aligned for FFTW's vector code.
template <typename Real>
class FftwBuffer {
 public:
  FftwBuffer() = default;
  explicit FftwBuffer(std::size_t size) : data_(Fftw<Real>::allocate(size)) {
    if (!data_) throw std::bad_alloc();
    std::fill_n(data_.get(), size, Real(0));
  }
  Real* data() { return data_.get(); }
  const Real* data() const { return data_.get(); }
  typename Fftw<Real>::Complex* complex() {
    return reinterpret_cast<typename Fftw<Real>::Complex*>(data_.get());
  }

 private:
  struct Free {
    void operator()(Real* pointer) const { Fftw<Real>::free(pointer); }
  };
  std::unique_ptr<Real, Free> data_;
};

/// Throws std::runtime_error where FFTW made no plan.
template <typename Real>
class FftwPlan {
 public:
  using Plan = typename Fftw<Real>::Plan;
  FftwPlan() = default;
  explicit FftwPlan(Plan plan) : plan_(plan) {
    if (!plan_) throw std::runtime_error("FFTW could not make a plan");
  }
  Plan get() const { return plan_.get(); }

 private:
  struct Destroy {
    void operator()(Plan plan) const { Fftw<Real>::destroy(plan); }
  };
  std::unique_ptr<std::remove_pointer_t<Plan>, Destroy> plan_;
};

}  // namespace slipstick::solver
