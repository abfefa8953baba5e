#pragma once

#include <array>
#include <complex>
#include <span>
#include <vector>

#include "solver/elasticity/linear_operator.hpp"
#include "solver/fft/padded_transform.hpp"

namespace slipstick::solver {

/// Discrete convolution by FFT (Liu, Wang and Liu 2000). Fields are padded with zeros to p1 >= 2 n1 - 1 by
/// p2 >= 2 n2 - 1 and the kernel wraps around, so that the cyclic convolution equals the linear one on the
/// n1 x n2 cells.
///
/// 1. Rows of the tractions are transformed forward.
/// 2. Each column is transformed forward, multiplied by the kernel's spectrum and transformed back, while it
///    is in cache.
/// 3. Rows of the displacements are transformed back.
///
/// The kernel is even or odd in each coordinate, so that its spectrum is real or imaginary, and a quadrant of
/// it is stored.
class Convolution final : public LinearOperator {
 public:
  /// Throws std::invalid_argument for a kernel of another shape than the normal, tangential or coupling one.
  Convolution(const Grid& grid, BlockKernel kernel, const ElasticLaw& law, const OperatorOptions& options);
  static double sent_bytes(const Grid& grid, const BlockKernel& kernel);
  Index padded1() const { return transform_.padded1(); }
  Index padded2() const { return transform_.padded2(); }
  std::span<double> idle_memory() override { return transform_.memory(); }

 private:
  using Spectrum = PaddedTransform::Spectrum;
  /// Factors at one column, for the kernel's components, row by row.
  struct Factors {
    std::array<const double*, 4> quadrant;  ///< m1/2 + 1 even frequencies along x1 from 0, then the odd ones
    std::array<double, 4> sign;             ///< of the spectrum at negative frequencies along x1
  };
  using Multiply = void (*)(const Spectrum&, const Factors&, Index);

  void do_apply(std::span<const double> traction, std::span<double> displacement) override;
  void set_spectra(const ElasticLaw& law);
  void set_factors(Component component, const std::complex<double>* even, const std::complex<double>* odd,
                   double* factors) const;
  std::size_t start(Index column, std::size_t slot) const;  ///< of a component's factors at a column
  Factors factors(Index column) const;
  static Multiply multiply_for(const BlockKernel& kernel);

  PaddedTransform transform_;
  std::vector<Component> components_;  ///< the distinct ones
  std::array<std::size_t, 4> slot_{};  ///< which of them stands at each place of the kernel
  FftwBuffer spectra_;                 ///< for each column, m1 + 1 factors of each component
  Multiply multiply_;
};

}  // namespace slipstick::solver
