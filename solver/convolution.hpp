#pragma once

#include <fftw3.h>

#include <map>
#include <memory>

#include "solver/linear_operator.hpp"

namespace slipstick::solver {

/// Memory from fftw_malloc, aligned for FFTW's vector code.
class FftwBuffer {
 public:
  FftwBuffer() = default;
  explicit FftwBuffer(std::size_t doubles);
  double* data() { return data_.get(); }
  const double* data() const { return data_.get(); }
  fftw_complex* complex() { return reinterpret_cast<fftw_complex*>(data_.get()); }
  std::size_t bytes() const { return doubles_ * sizeof(double); }

 private:
  struct Free {
    void operator()(double* pointer) const { fftw_free(pointer); }
  };
  std::unique_ptr<double, Free> data_;
  std::size_t doubles_ = 0;
};

struct FftwPlanDestroy {
  void operator()(fftw_plan plan) const { fftw_destroy_plan(plan); }
};
using FftwPlan = std::unique_ptr<std::remove_pointer_t<fftw_plan>, FftwPlanDestroy>;

/// The smallest even 2^a 3^b 5^c 7^d >= max(minimum, 4): lengths that FFTW transforms quickly.
Index fast_length(Index minimum);

/// Discrete convolution by FFT (Liu, Wang and Liu 2000): fields are padded with zeros to p1 >= 2 n1 - 1 by
/// p2 >= 2 n2 - 1, the kernel wraps around, so the cyclic convolution equals the linear one on the n1 x n2
/// cells.
///
/// One forward transform per input field, one backward per output field. The kernel is even or odd in each
/// coordinate, so its transform is real or imaginary and a quadrant of it is stored. Only the n1 rows that
/// hold cells are transformed along x2; then blocks of columns go through forward transform, kernel product
/// and backward transform while they are in cache, and the n1 wanted rows go back.
class Convolution final : public LinearOperator {
 public:
  Convolution(const Grid& grid, BlockKernel kernel, const ElasticPair& pair, const OperatorOptions& options);
  std::size_t bytes() const override;
  static double predicted_bytes(const Grid& grid, const BlockKernel& kernel, int threads);
  Index padded1() const { return p1_; }
  Index padded2() const { return p2_; }

 private:
  void do_apply(std::span<const double> traction, std::span<double> displacement) override;
  FftwBuffer kernel_spectrum(Component component, const ElasticPair& pair) const;
  void make_plans(unsigned flags);
  void row_forward(int thread, Index row, const double* values);
  void row_backward(int thread, Index row, double* values);
  void convolve_columns(int thread, Index first_column);
  void multiply_columns(double* block, Index first_column) const;

  Index p1_;
  Index p2_;
  Index row_stride_;  ///< complex numbers from one row of the spectrum to the next
  int threads_;
  std::map<Component, FftwBuffer> spectra_;  ///< (p1/2 + 1) rows of row_stride_ reals, 1/(p1 p2) included
  FftwBuffer row_spectra_;                   ///< max(inputs, outputs) fields of n1 rows
  std::vector<FftwBuffer> row_buffer_;       ///< one padded row, for each thread
  std::vector<FftwBuffer> column_block_;     ///< max(inputs, outputs) blocks of columns, for each thread
  FftwPlan row_forward_;
  FftwPlan row_backward_;
  FftwPlan column_forward_;
  FftwPlan column_backward_;
};

}  // namespace slipstick::solver
