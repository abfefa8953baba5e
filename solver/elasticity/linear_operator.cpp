#include "solver/elasticity/linear_operator.hpp"

#include <set>

#include "solver/elasticity/convolution.hpp"
#include "solver/elasticity/direct.hpp"
#include "solver/elasticity/mirrored_convolution.hpp"

namespace slipstick::solver {

std::vector<Component> BlockKernel::distinct() const {
  const std::set<Component> all(components.begin(), components.end());
  return {all.begin(), all.end()};
}

BlockKernel normal_kernel() { return {1, 1, {Component::k33}}; }

BlockKernel tangential_kernel() { return {2, 2, {Component::k11, Component::k12, Component::k12, Component::k22}}; }

BlockKernel coupling_kernel() { return {2, 1, {Component::k13, Component::k23}}; }

BlockKernel shear_kernel() { return {1, 2, {Component::k13, Component::k23}}; }

Part part_of(const Grid& grid, const BlockKernel& kernel, bool diagonal) {
  const bool tangential = kernel == tangential_kernel();
  if (grid.quadrant && !tangential && kernel != normal_kernel()) {
    throw std::invalid_argument("only the normal and the tangential kernel have a quadrant's mirrors");
  }
  if (!diagonal) return grid.quadrant ? Part::quadrant : Part::whole;
  if (!tangential || !grid.quadrant || grid.n1 != grid.n2 || grid.h1 != grid.h2) {
    throw std::invalid_argument("only torsion on a square quadrant mirrors at the diagonal");
  }
  return Part::diagonal;
}

void mirror_rows(double* field, Index n, const IndexRange& rows) {
  double* const second = field + n * n;
  for (Index j = 0; j < n; ++j) {
    for (Index i = rows.first; i < rows.last; ++i) second[j * n + i] = -field[i * n + j];
  }
}

std::unique_ptr<LinearOperator> make_operator(OperatorKind kind, const Grid& grid, const BlockKernel& kernel,
                                              const ElasticLaw& law, const OperatorOptions& options) {
  const bool whole = part_of(grid, kernel, options.diagonal) == Part::whole;
  if (kind != OperatorKind::dcfft && !whole) throw std::invalid_argument("only dcfft knows quadrants");
  switch (kind) {
    case OperatorKind::dcfft:
      if (whole) return std::make_unique<Convolution>(grid, kernel, law, options);
      return std::make_unique<MirroredConvolution>(grid, kernel, law, options);
    case OperatorKind::direct:
      return std::make_unique<DirectSum>(grid, kernel, law, options);
    case OperatorKind::dense:
      return std::make_unique<DenseMatrix>(grid, kernel, law);
  }
  throw std::logic_error("unknown operator kind");
}

double predicted_sent_bytes(const Grid& grid, const BlockKernel& kernel) {
  return grid.quadrant ? MirroredConvolution::sent_bytes(grid, kernel) : Convolution::sent_bytes(grid, kernel);
}

}  // namespace slipstick::solver
