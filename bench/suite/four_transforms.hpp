#pragma once

#include "solver/fft/fftw.hpp"

namespace slipstick::bench {

/// Two forward and two backward transforms of padded fields, by plain FFTW: the least time of a convolution
/// that does not exploit its padding, and the unit in which times of different machines can be compared.
class FourTransforms {
 public:
  explicit FourTransforms(solver::Index cells)
      : padded_(static_cast<int>(solver::fast_length(2 * cells - 1))),
        real_(size()),
        spectrum_(size() + 2 * static_cast<std::size_t>(padded_)),
        forward_(fftw_plan_dft_r2c_2d(padded_, padded_, real_.data(), spectrum_.complex(), FFTW_ESTIMATE)),
        backward_(fftw_plan_dft_c2r_2d(padded_, padded_, spectrum_.complex(), real_.data(), FFTW_ESTIMATE)) {
    std::fill_n(real_.data(), size(), 0.0);  // planning has written there
  }

  void operator()() {
    for (int i = 0; i < 2; ++i) {
      fftw_execute_dft_r2c(forward_.get(), real_.data(), spectrum_.complex());
      fftw_execute_dft_c2r(backward_.get(), spectrum_.complex(), real_.data());
    }
  }

 private:
  std::size_t size() const { return static_cast<std::size_t>(padded_) * static_cast<std::size_t>(padded_); }

  int padded_;
  solver::FftwBuffer real_;
  solver::FftwBuffer spectrum_;
  solver::FftwPlan forward_;
  solver::FftwPlan backward_;
};

}  // namespace slipstick::bench
