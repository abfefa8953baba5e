#pragma once

#include <array>
#include <memory>
#include <span>

#include "solver/elasticity/linear_operator.hpp"

namespace slipstick::solver {

/// Whether a quadrant's torsion also mirrors at the diagonal: q2(x1, x2) = -q1(x2, x1).
enum class Diagonal { no, yes };

/// Preconditioner for conjugate gradients with an influence operator: the inverse of its Fourier symbol on
/// the half-space, |xi|/C33 for the normal and |xi|/S (I + N/(S - N) n n^T), n = xi/|xi|, for the tangential
/// kernel (S and N the pair's shear and Poisson compliances, C33 its normal compliance), as a periodic
/// convolution on the grid itself, which is padded with zeros only where its lengths are not fast ones, or
/// where fields reach its edge: without zeros between them opposite edges would be neighbours, which takes
/// conjugate gradients on a full grid twice as many steps.
/// Self-adjoint and positive definite: at zero frequency, where the symbol vanishes, half of the smallest
/// frequency stands in for |xi|, without the term in n n^T; on the Nyquist rows and columns, where it would
/// not be Hermitian, the cross term is left out. Errors are those of the transforms, a few eps of the largest
/// value.
///
/// On a quadrant the fields' mirror images are theirs by cosine and sine transforms: pressures even in both
/// coordinates; q1 even in x1 and odd in x2, q2 the reverse. The operator is the one on the whole grid.
class InverseSymbol {
 public:
  virtual ~InverseSymbol() = default;

  /// Overwrites a field (1 or 2 times grid.cells() values) by its filtered values. Allocates nothing. With
  /// Diagonal::yes the second component is written, not read. Throws std::invalid_argument for other sizes.
  virtual void apply(std::span<double> field) = 0;
  /// Means of the diagonal symbols over all frequencies, one per component (for the normal kernel both are
  /// the same): the diagonal of the operator on a whole grid, and on a quadrant away from its axes.
  virtual std::array<double, 2> diagonal() const = 0;
};

/// The kernel is the normal or the tangential one; others throw std::invalid_argument, as does Diagonal::yes
/// where the grid is no quadrant that its diagonal halves or the kernel not tangential. at_edge: whether
/// fields reach the edge of a whole grid.
std::unique_ptr<InverseSymbol> make_inverse_symbol(const Grid& grid, const BlockKernel& kernel,
                                                   const ElasticPair& pair, Diagonal diagonal = Diagonal::no,
                                                   int threads = 1, bool at_edge = false);

}  // namespace slipstick::solver
