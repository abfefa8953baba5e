#pragma once

#include <fftw3.h>

#include <algorithm>
#include <memory>
#include <new>
#include <stdexcept>
#include <type_traits>

#include "solver/grid/grid.hpp"

/// FFTW's C interface with owned handles. Plans are estimated, since measured plans differ from run to run,
/// and with them the bits.
namespace slipstick::solver {

/// An index as a std::size_t.
inline std::size_t count(Index n) { return static_cast<std::size_t>(n); }

/// Complex lines of one plan. step: from one value of a line to the next; distance: from one line to the next.
struct FftwLines {
  int length;
  int count;
  int in_step;
  int in_distance;
  int out_step;
  int out_distance;
};

inline fftw_plan plan_transform(int length, fftw_complex* in, fftw_complex* out, int direction) {
  return fftw_plan_dft_1d(length, in, out, direction, FFTW_ESTIMATE);
}
inline fftw_plan plan_transforms(const FftwLines& lines, fftw_complex* in, fftw_complex* out, int direction) {
  return fftw_plan_many_dft(1, &lines.length, lines.count, in, nullptr, lines.in_step, lines.in_distance, out, nullptr,
                            lines.out_step, lines.out_distance, direction, FFTW_ESTIMATE);
}
inline fftw_plan plan_row_forward(int length, double* in, fftw_complex* out) {
  return fftw_plan_many_dft_r2c(1, &length, 1, in, nullptr, 1, 0, out, nullptr, 1, 0, FFTW_ESTIMATE);
}
inline fftw_plan plan_row_backward(int length, fftw_complex* in, double* out) {
  return fftw_plan_many_dft_c2r(1, &length, 1, in, nullptr, 1, 0, out, nullptr, 1, 0, FFTW_ESTIMATE);
}

/// Zeroed memory, aligned for FFTW's vector code.
class FftwBuffer {
 public:
  FftwBuffer() = default;
  explicit FftwBuffer(std::size_t size) : data_(fftw_alloc_real(size)) {
    if (!data_) throw std::bad_alloc();
    std::fill_n(data_.get(), size, 0.0);
  }
  double* data() { return data_.get(); }
  const double* data() const { return data_.get(); }
  fftw_complex* complex() { return reinterpret_cast<fftw_complex*>(data_.get()); }

 private:
  struct Free {
    void operator()(double* pointer) const { fftw_free(pointer); }
  };
  std::unique_ptr<double, Free> data_;
};

/// An owned plan. Throws std::runtime_error if FFTW made none.
class FftwPlan {
 public:
  FftwPlan() = default;
  explicit FftwPlan(fftw_plan plan) : plan_(plan) {
    if (!plan_) throw std::runtime_error("FFTW could not make a plan");
  }
  fftw_plan get() const { return plan_.get(); }

 private:
  struct Destroy {
    void operator()(fftw_plan plan) const { fftw_destroy_plan(plan); }
  };
  std::unique_ptr<std::remove_pointer_t<fftw_plan>, Destroy> plan_;
};

/// The plans of a two-dimensional transform.
struct PlanePlans {
  FftwPlan row_forward;
  FftwPlan row_backward;
  FftwPlan column_forward;
  FftwPlan column_backward;
};

}  // namespace slipstick::solver
