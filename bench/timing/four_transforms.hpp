#pragma once

#include "solver/fft/fftw.hpp"

namespace slipstick::bench {

/// Two forward and two backward transforms of padded fields, by FFTW alone: what a convolution that makes
/// nothing of its padding cannot go below. The unit in which times on different machines can be compared.
template <typename Real>
class FourTransforms {
 public:
  explicit FourTransforms(solver::Index cells)
      : padded_(static_cast<int>(solver::fast_length(2 * cells - 1))),
        real_(size()),
        spectrum_(size() + 2 * static_cast<std::size_t>(padded_)),
        forward_(Library::plan_plane_forward(plane(), real_.data(), spectrum_.complex())),
        backward_(Library::plan_plane_backward(plane(), spectrum_.complex(), real_.data())) {
    std::fill_n(real_.data(), size(), Real(0));  // planning has written there
  }

  void operator()() {
    for (int i = 0; i < 2; ++i) {
      Library::execute(forward_.get(), real_.data(), spectrum_.complex());
      Library::execute(backward_.get(), spectrum_.complex(), real_.data());
    }
  }

 private:
  using Library = solver::Fftw<Real>;

  std::size_t size() const { return static_cast<std::size_t>(padded_) * static_cast<std::size_t>(padded_); }
  solver::FftwPlane plane() const {
    return {
        .lengths = {padded_, padded_}, .reals = {padded_, padded_}, .numbers = {padded_, padded_ / 2 + 1}};
  }

  int padded_;
  solver::FftwBuffer<Real> real_;
  solver::FftwBuffer<Real> spectrum_;
  solver::FftwPlan<Real> forward_;
  solver::FftwPlan<Real> backward_;
};

}  // namespace slipstick::bench
