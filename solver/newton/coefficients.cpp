#include "solver/newton/coefficients.hpp"

#include <Eigen/QR>

namespace slipstick::solver {

Coefficients least_solution(const CoefficientMatrix& matrix, const Coefficients& right) {
  return matrix.completeOrthogonalDecomposition().solve(right);
}

void SmallCholesky::compute(const CoefficientMatrix& matrix) { factor_.compute(matrix); }

bool SmallCholesky::is_definite() const { return factor_.info() == Eigen::Success; }

Coefficients SmallCholesky::solve(const Coefficients& right) const { return factor_.solve(right); }

Coefficients SmallCholesky::diagonal() const { return factor_.matrixLLT().diagonal(); }

}  // namespace slipstick::solver
