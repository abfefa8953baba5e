#pragma once

#include <array>
#include <memory>
#include <span>

#include "solver/elasticity/linear_operator.hpp"

namespace slipstick::solver {

/// Preconditioner for conjugate gradients with an influence operator: the inverse of the law's symbol, as a
/// convolution over the period of the grid.
///
/// 1. Fourier transform of the field. It is padded with zeros to fast lengths, and, if fields reach the edge,
///    by two cells, since neighbouring opposite edges would double the number of iterations.
/// 2. Each frequency times the inverse symbol (symbol_table.hpp).
/// 3. The inverse transform.
///
/// On a quadrant the same for the field and its mirror images, by cosine and sine transforms
/// (mirrored_inverse_symbol.cpp). Self-adjoint and positive definite; the transforms round by a few eps of
/// the largest value.
class InverseSymbol {
 public:
  virtual ~InverseSymbol() = default;

  /// Overwrites a field (1 or 2 times grid.cells() values) by its filtered values. Allocates nothing. On
  /// Part::diagonal the second component is written, not read. Throws std::invalid_argument for other sizes.
  virtual void apply(std::span<double> field) = 0;
  /// Means of the diagonal symbols over all frequencies, one per component (equal for the normal kernel): the
  /// diagonal of the operator on a whole grid, and on a quadrant away from its axes.
  virtual std::array<double, 2> diagonal() const = 0;
  /// The part of OperatorOptions::memory that it does not use.
  virtual std::span<double> idle_memory() const { return {}; }
};

/// The inverse symbol for the fields of part_of(). Throws as that, and std::invalid_argument for a kernel
/// other than the normal or the tangential one.
std::unique_ptr<InverseSymbol> make_inverse_symbol(const Grid& grid, const BlockKernel& kernel, const ElasticLaw& law,
                                                   const OperatorOptions& options = {});
/// On a quadrant.
std::unique_ptr<InverseSymbol> make_mirrored_inverse_symbol(const Grid& grid, bool tangential, const ElasticLaw& law,
                                                            const OperatorOptions& options);

}  // namespace slipstick::solver
