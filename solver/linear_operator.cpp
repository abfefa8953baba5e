#include "solver/linear_operator.hpp"

#include "solver/convolution.hpp"
#include "solver/direct.hpp"

namespace slipstick::solver {

BlockKernel normal_kernel() { return {1, 1, {Component::k33}}; }

BlockKernel tangential_kernel() {
  return {2, 2, {Component::k11, Component::k12, Component::k12, Component::k22}};
}

BlockKernel coupling_kernel() { return {2, 1, {Component::k13, Component::k23}}; }

std::unique_ptr<LinearOperator> make_operator(OperatorKind kind, const Grid& grid, const BlockKernel& kernel,
                                              const ElasticPair& pair, const OperatorOptions& options) {
  switch (kind) {
    case OperatorKind::dcfft:
      return std::make_unique<Convolution>(grid, kernel, pair, options);
    case OperatorKind::direct:
      return std::make_unique<DirectSum>(grid, kernel, pair, options);
    case OperatorKind::dense:
      return std::make_unique<DenseMatrix>(grid, kernel, pair);
  }
  throw std::logic_error("unknown operator kind");
}

double predicted_bytes(OperatorKind kind, const Grid& grid, const BlockKernel& kernel,
                       const OperatorOptions& options) {
  switch (kind) {
    case OperatorKind::dcfft:
      return Convolution::predicted_bytes(grid, kernel, options.threads);
    case OperatorKind::direct:
      return DirectSum::predicted_bytes(grid, kernel);
    case OperatorKind::dense:
      return DenseMatrix::predicted_bytes(grid, kernel);
  }
  throw std::logic_error("unknown operator kind");
}

}  // namespace slipstick::solver
