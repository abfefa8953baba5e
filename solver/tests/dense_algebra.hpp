#pragma once

#include <Eigen/Core>

/// Dense linear algebra that tests compare with, compiled once.
namespace slipstick::solver {

/// The solution of a regular system.
Eigen::VectorXd dense_solution(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

/// Eigenvalues of a symmetric matrix, rising.
Eigen::VectorXd dense_eigenvalues(const Eigen::MatrixXd& matrix);

}  // namespace slipstick::solver
