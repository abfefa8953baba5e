#pragma once

#include <array>
#include <cstddef>

#include "solver/grid/grid.hpp"

/// Stresses in a half-space x3 > 0 under uniform tractions on one rectangular cell of its surface, in closed
/// form: Love (1929) for the pressure, Cerruti's point solution integrated over the rectangle for the shear.
namespace slipstick::solver {

/// Components of a stress tensor, in the order in which they are stored.
enum Stress : std::size_t { k11, k22, k33, k12, k13, k23 };
inline constexpr std::size_t kStresses = 6;
/// Tractions on the surface, in the order in which the kernels name them: the pressure, then the shear.
inline constexpr std::size_t kTractions = 3;

/// A stress as influence of a traction: which traction, which stress.
struct Influence {
  std::size_t traction;
  Stress stress;
};

/// One function of the offset from a cell to a point, and the one or two influences that it is.
struct StressKernel {
  std::array<Influence, 2> influences;
  std::size_t count;  ///< of influences
  Parity parity;
};
inline constexpr std::size_t kStressKernels = 15;
extern const std::array<StressKernel, kStressKernels> stress_kernels;

/// Values of all kernels.
using KernelValues = std::array<double, kStressKernels>;

/// Second primitive in x1 and x2 of each kernel's point solution, with its kernel's opposite parity: a kernel
/// is the difference of its values at the four corners of the cell. depth > 0. The tractions are one and
/// point along x3 (pressure), x1 and x2; a tensile stress is positive.
KernelValues corner_function(double x1, double x2, double depth, double poisson);

}  // namespace slipstick::solver
