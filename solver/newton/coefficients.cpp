#include "solver/newton/coefficients.hpp"

#include <gsl/gsl_linalg.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <limits>

namespace slipstick::solver {
namespace {

using SmallRows =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, kMaxConditions, kMaxConditions>;

/// GSL's views of a matrix or vector of Eigen.
struct GslMatrix {
  explicit GslMatrix(SmallRows& of)
      : view(gsl_matrix_view_array(of.data(), static_cast<std::size_t>(of.rows()),
                                   static_cast<std::size_t>(of.cols()))) {}
  operator gsl_matrix*() { return &view.matrix; }
  gsl_matrix_view view;
};
struct GslVector {
  explicit GslVector(Coefficients& of) : view(gsl_vector_view_array(of.data(), static_cast<std::size_t>(of.size()))) {}
  operator gsl_vector*() { return &view.vector; }
  gsl_vector_view view;
};

struct FullQr {
  SmallRows q, r;  ///< square; as the matrix
};
FullQr full_qr(const CoefficientMatrix& matrix) {
  SmallRows factored = matrix;
  Coefficients tau(std::min(matrix.rows(), matrix.cols()));
  FullQr full{SmallRows(matrix.rows(), matrix.rows()), SmallRows(matrix.rows(), matrix.cols())};
  GslMatrix a(factored), q(full.q), r(full.r);
  GslVector scales(tau);
  gsl_linalg_QR_decomp(a, scales);
  gsl_linalg_QR_unpack(a, scales, q, r);
  return full;
}

}  // namespace

// By A P = Q diag(R, 0) Z. GSL requires at least as many rows as columns, so rows of zeros are added.
Coefficients least_solution(const CoefficientMatrix& matrix, const Coefficients& right) {
  const Eigen::Index n = matrix.cols();
  Coefficients unknown = Coefficients::Constant(n, std::numeric_limits<double>::quiet_NaN());
  const double largest = matrix.size() > 0 ? matrix.cwiseAbs().maxCoeff() : 0.0;
  // GSL would end the program.
  if (!matrix.allFinite()) return unknown;
  if (largest == 0.0) return Coefficients::Zero(n);

  const Eigen::Index m = std::max(matrix.rows(), n);
  SmallRows factored = SmallRows::Zero(m, n);
  factored.topRows(matrix.rows()) = matrix;
  Coefficients b = Coefficients::Zero(m);
  b.head(right.size()) = right;
  Coefficients tau_q(n), tau_z(n), x(n), work(n), residual(m);
  std::array<std::size_t, kMaxConditions> columns{};
  gsl_permutation order{static_cast<std::size_t>(n), columns.data()};
  GslMatrix a(factored);
  GslVector q(tau_q), z(tau_z), space(work), from(b), to(x), left(residual);
  // A pivot below is rounding.
  const double tolerance = largest * std::numeric_limits<double>::epsilon() * static_cast<double>(n);
  std::size_t independent = 0;
  gsl_linalg_COD_decomp_e(a, q, z, &order, tolerance, &independent, space);
  if (independent == 0) return unknown;  // numbers so large that their squares are infinite
  gsl_linalg_COD_lssolve(a, q, z, &order, independent, from, to, left);
  return x;
}

SmallQr small_qr(const CoefficientMatrix& matrix) {
  const FullQr full = full_qr(matrix);
  return {full.q.leftCols(matrix.cols()), full.r.topRows(matrix.cols())};
}

CoefficientMatrix orthonormal_basis(const Coefficients& vector) { return full_qr(vector).q; }

void SmallCholesky::compute(const CoefficientMatrix& matrix) { factor_.compute(matrix); }

bool SmallCholesky::is_definite() const { return factor_.info() == Eigen::Success; }

Coefficients SmallCholesky::solve(const Coefficients& right) const { return factor_.solve(right); }

Coefficients SmallCholesky::diagonal() const { return factor_.matrixLLT().diagonal(); }

Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.colPivHouseholderQr().solve(right);
}

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& matrix) {
  return matrix.colPivHouseholderQr().solve(Eigen::MatrixXd::Identity(matrix.rows(), matrix.rows()));
}

}  // namespace slipstick::solver
