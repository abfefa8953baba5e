#include "solver/tests/dense_algebra.hpp"

#include <Eigen/Dense>

namespace slipstick::solver {

Eigen::VectorXd dense_solution(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.fullPivLu().solve(right);
}

Eigen::VectorXd dense_eigenvalues(const Eigen::MatrixXd& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace slipstick::solver
