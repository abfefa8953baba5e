#include "solver/newton/load_balance.hpp"

#include <Eigen/QR>

namespace slipstick::solver {

Coefficients least_solution(const CoefficientMatrix& matrix, const Coefficients& right) {
  return matrix.completeOrthogonalDecomposition().solve(right);
}

}  // namespace slipstick::solver
