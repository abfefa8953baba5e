#pragma once

#include <Eigen/Cholesky>

namespace slipstick::solver {

using Eigen::Index;

/// The rigid motions of a body on a surface (two translations and a rotation), and one more unknown.
inline constexpr int kMaxConditions = 4;

/// One value a condition, and a matrix of them; nothing is allocated.
using Coefficients = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxConditions, 1>;
using CoefficientMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxConditions, kMaxConditions>;

/// The x of least length among the least-squares solutions of matrix x = right. A single cell, for example,
/// does not determine its motion.
Coefficients least_solution(const CoefficientMatrix& matrix, const Coefficients& right);

/// matrix = q r with orthonormal columns q and a triangle r, for no more columns than rows.
struct SmallQr {
  CoefficientMatrix q, r;
};
SmallQr small_qr(const CoefficientMatrix& matrix);

/// Orthonormal columns; the first has the direction of a vector, up to its sign.
CoefficientMatrix orthonormal_basis(const Coefficients& vector);

/// Cholesky's factor L of a small symmetric matrix L L^T.
class SmallCholesky {
 public:
  SmallCholesky() = default;
  explicit SmallCholesky(const CoefficientMatrix& matrix) { compute(matrix); }
  void compute(const CoefficientMatrix& matrix);

  /// Whether the matrix is positive definite; solve() needs that.
  bool is_definite() const;
  Coefficients solve(const Coefficients& right) const;
  /// The diagonal of L.
  Coefficients diagonal() const;

 private:
  Eigen::LLT<CoefficientMatrix> factor_;
};

/// Least squares of a tall system of independent columns, and the pseudo-inverse of such a matrix; of any size.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& matrix);

}  // namespace slipstick::solver
