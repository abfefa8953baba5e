#include "solver/newton/coefficients.hpp"

#include <Eigen/QR>

namespace slipstick::solver {

Coefficients least_solution(const CoefficientMatrix& matrix, const Coefficients& right) {
  return matrix.completeOrthogonalDecomposition().solve(right);
}

SmallQr small_qr(const CoefficientMatrix& matrix) {
  const Eigen::HouseholderQR<CoefficientMatrix> factored(matrix);
  return {factored.householderQ() * CoefficientMatrix::Identity(matrix.rows(), matrix.cols()),
          factored.matrixQR().topRows(matrix.cols()).triangularView<Eigen::Upper>()};
}

CoefficientMatrix orthonormal_basis(const Coefficients& vector) {
  return Eigen::HouseholderQR<CoefficientMatrix>(vector).householderQ();
}

void SmallCholesky::compute(const CoefficientMatrix& matrix) { factor_.compute(matrix); }

bool SmallCholesky::is_definite() const { return factor_.info() == Eigen::Success; }

Coefficients SmallCholesky::solve(const Coefficients& right) const { return factor_.solve(right); }

Coefficients SmallCholesky::diagonal() const { return factor_.matrixLLT().diagonal(); }

Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.colPivHouseholderQr().solve(right);
}

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& matrix) {
  return matrix.completeOrthogonalDecomposition().pseudoInverse();
}

}  // namespace slipstick::solver
