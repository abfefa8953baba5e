#pragma once

#include <array>
#include <memory>
#include <span>

#include "solver/elasticity/linear_operator.hpp"

namespace slipstick::solver {

/// Preconditioner for conjugate gradients with an influence operator: the inverse of the law's symbol, as a
/// periodic convolution on the grid itself. The grid is padded with zeros only where its lengths are not fast
/// ones, or where fields reach its edge: without zeros between them opposite edges would be neighbours, which
/// takes conjugate gradients on a full grid twice as many steps. On a quadrant it is the same for the fields'
/// mirror images, by cosine and sine transforms.
/// Self-adjoint and positive definite. Errors are those of the transforms, a few eps of the largest value.
class InverseSymbol {
 public:
  virtual ~InverseSymbol() = default;

  /// Overwrites a field (1 or 2 times grid.cells() values) by its filtered values. Allocates nothing. On
  /// Part::diagonal the second component is written, not read. Throws std::invalid_argument for other sizes.
  virtual void apply(std::span<double> field) = 0;
  /// Means of the diagonal symbols over all frequencies, one per component (for the normal kernel both are
  /// the same): the diagonal of the operator on a whole grid, and on a quadrant away from its axes.
  virtual std::array<double, 2> diagonal() const = 0;
};

/// The inverse symbol of the fields that part_of() says. Throws what that throws, and std::invalid_argument
/// for another kernel than the normal or the tangential one.
std::unique_ptr<InverseSymbol> make_inverse_symbol(const Grid& grid, const BlockKernel& kernel,
                                                   const ElasticLaw& law,
                                                   const OperatorOptions& options = {});

}  // namespace slipstick::solver
