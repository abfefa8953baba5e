#pragma once

#include <Eigen/Core>
#include <map>

#include "solver/elasticity/linear_operator.hpp"

namespace slipstick::solver {

/// Matrix-free summation over source cells; cells without traction cost nothing.
class DirectSum final : public LinearOperator {
 public:
  DirectSum(const Grid& grid, BlockKernel kernel, const ElasticLaw& law, const OperatorOptions& options);

 private:
  void do_apply(std::span<const double> traction, std::span<double> displacement) override;

  /// Each component at all offsets -(n-1) .. n-1, (2 n1 - 1) x (2 n2 - 1) values.
  std::map<Component, std::vector<double>> coefficients_;
  std::vector<double> source_;
  int threads_;
};

/// The whole matrix, for small grids: the plainest form to check the others against.
class DenseMatrix final : public LinearOperator {
 public:
  DenseMatrix(const Grid& grid, BlockKernel kernel, const ElasticLaw& law);
  const Eigen::MatrixXd& matrix() const { return matrix_; }

 private:
  void do_apply(std::span<const double> traction, std::span<double> displacement) override;

  Eigen::MatrixXd matrix_;
  Eigen::VectorXd source_;
};

}  // namespace slipstick::solver
