#include "solver/elasticity/linear_operator.hpp"

#include "solver/elasticity/convolution.hpp"
#include "solver/elasticity/direct.hpp"
#include "solver/elasticity/mirrored_convolution.hpp"

namespace slipstick::solver {

BlockKernel normal_kernel() { return {1, 1, {Component::k33}}; }

BlockKernel tangential_kernel() {
  return {2, 2, {Component::k11, Component::k12, Component::k12, Component::k22}};
}

BlockKernel coupling_kernel() { return {2, 1, {Component::k13, Component::k23}}; }

BlockKernel shear_kernel() { return {1, 2, {Component::k13, Component::k23}}; }

namespace {

std::unique_ptr<LinearOperator> make_convolution(const Grid& grid, const BlockKernel& kernel,
                                                 const ElasticPair& pair, const OperatorOptions& options) {
  if (grid.quadrant) {
    return std::make_unique<MirroredConvolution>(grid, kernel, pair, options, options.diagonal);
  }
  return std::make_unique<Convolution>(grid, kernel, pair, options);
}

void require_whole(const Grid& grid) {
  if (grid.quadrant) throw std::invalid_argument("only dcfft knows quadrants");
}

}  // namespace

std::unique_ptr<LinearOperator> make_operator(OperatorKind kind, const Grid& grid, const BlockKernel& kernel,
                                              const ElasticPair& pair, const OperatorOptions& options) {
  if (kind != OperatorKind::dcfft) require_whole(grid);
  switch (kind) {
    case OperatorKind::dcfft:
      return make_convolution(grid, kernel, pair, options);
    case OperatorKind::direct:
      return std::make_unique<DirectSum>(grid, kernel, pair, options);
    case OperatorKind::dense:
      return std::make_unique<DenseMatrix>(grid, kernel, pair);
  }
  throw std::logic_error("unknown operator kind");
}

double predicted_sent_bytes(const Grid& grid, const BlockKernel& kernel) {
  return grid.quadrant ? MirroredConvolution::sent_bytes(grid, kernel)
                       : Convolution::sent_bytes(grid, kernel);
}

}  // namespace slipstick::solver
