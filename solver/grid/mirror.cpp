#include "solver/grid/mirror.hpp"

#include <stdexcept>

namespace slipstick::solver {
namespace {

using Matrix = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using ConstComponent = Eigen::Map<const Matrix>;
using MutableComponent = Eigen::Map<Matrix>;

}  // namespace

Symmetry normal_symmetry() { return {{1, 1}}; }
Symmetry torsion_symmetry() { return {{1, -1}, {-1, 1}}; }

Grid whole_grid(const Grid& quadrant) {
  if (!quadrant.quadrant) throw std::invalid_argument("only a quadrant's grid has mirror images");
  return {2 * quadrant.n1, 2 * quadrant.n2, quadrant.h1, quadrant.h2, false, quadrant.ranks};
}

Grid quadrant_of(const Grid& whole) {
  if (whole.quadrant) throw std::invalid_argument("a quadrant of a quadrant");
  if (whole.n1 % 2 != 0 || whole.n2 % 2 != 0) {
    throw std::invalid_argument("the quadrant of a grid with an odd number of cells");
  }
  return {whole.n1 / 2, whole.n2 / 2, whole.h1, whole.h2, true, whole.ranks};
}

Eigen::ArrayXd unfold(const Grid& quadrant, const Eigen::ArrayXd& field, const Symmetry& symmetry) {
  const Grid whole = whole_grid(quadrant);
  const auto components = static_cast<Index>(symmetry.size());
  if (field.size() != components * quadrant.cells()) {
    throw std::invalid_argument("unfolding a field of another size than its quadrant's");
  }
  Eigen::ArrayXd images(components * whole.cells());
  for (Index c = 0; c < components; ++c) {
    const Parity parity = symmetry[static_cast<std::size_t>(c)];
    const ConstComponent from(field.data() + c * quadrant.cells(), quadrant.n1, quadrant.n2);
    MutableComponent to(images.data() + c * whole.cells(), whole.n1, whole.n2);
    to.bottomRightCorner(quadrant.n1, quadrant.n2) = from;
    to.bottomLeftCorner(quadrant.n1, quadrant.n2) = parity.x2 * from.rowwise().reverse();
    to.topRows(quadrant.n1) = parity.x1 * to.bottomRows(quadrant.n1).colwise().reverse();
  }
  return images;
}

Eigen::ArrayXd restrict_to_quadrant(const Grid& whole, const Eigen::ArrayXd& field) {
  const Grid quadrant = quadrant_of(whole);
  const Index components = field.size() / whole.cells();
  if (field.size() != components * whole.cells()) {
    throw std::invalid_argument("restricting a field of another size than its grid's");
  }
  Eigen::ArrayXd part(components * quadrant.cells());
  for (Index c = 0; c < components; ++c) {
    const ConstComponent from(field.data() + c * whole.cells(), whole.n1, whole.n2);
    MutableComponent(part.data() + c * quadrant.cells(), quadrant.n1, quadrant.n2) =
        from.bottomRightCorner(quadrant.n1, quadrant.n2);
  }
  return part;
}

}  // namespace slipstick::solver
