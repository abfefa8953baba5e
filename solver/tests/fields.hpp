#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <random>
#include <span>

#include "solver/elasticity/law/half_spaces.hpp"
#include "solver/elasticity/linear_operator.hpp"

namespace slipstick::solver {

/// Values between -1 and 1.
inline Eigen::ArrayXd random_field(Index size, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return Eigen::ArrayXd::NullaryExpr(size, [&] { return uniform(generator); });
}

/// A vector field on n x n cells with its second component set to q2(x1, x2) = -q1(x2, x1).
inline Eigen::ArrayXd mirrored_about_diagonal(Eigen::ArrayXd field, Index n) {
  field.tail(n * n).reshaped(n, n) = -field.head(n * n).reshaped(n, n).transpose();
  return field;
}

/// NaN where a value is NaN, as is their difference.
inline double largest(const Eigen::ArrayXd& values) { return values.abs().maxCoeff<Eigen::PropagateNaN>(); }
inline double relative_difference(const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) {
  return largest(a - b) / largest(b);
}

inline Eigen::ArrayXd applied(LinearOperator& op, const Eigen::ArrayXd& traction) { return op.applied(traction); }

/// Poisson's ratios and moduli whose mismatch is not zero.
inline HalfSpaces dissimilar_pair() { return HalfSpaces(elastic_pair({1.0, 0.3}, {2.5, 0.1})); }

/// A multiple of the identity, which may be what no elastic body is.
class Multiple final : public LinearOperator {
 public:
  Multiple(const Grid& grid, double factor) : LinearOperator(grid, tangential_kernel()), factor_(factor) {}

 private:
  void do_apply(std::span<const double> traction, std::span<double> displacement) override {
    for (std::size_t i = 0; i < traction.size(); ++i) displacement[i] = factor_ * traction[i];
  }
  double factor_;
};

}  // namespace slipstick::solver
