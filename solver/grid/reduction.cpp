#include "solver/grid/reduction.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using Matrix = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using ConstComponent = Eigen::Map<const Matrix>;
using MutableComponent = Eigen::Map<Matrix>;

/// Mirror images differ by this at most, relative: the rounding of a solve.
constexpr double kImageRounding = 1e-13;
/// Rounding of transforms, over the largest value of the field.
constexpr double kTransformRounding = 1e-12;

/// Equal up to rounding, with infinite values in the same places.
template <typename A, typename B>
bool same(const A& a, const B& b) {
  for (Index i = 0; i < a.rows(); ++i) {
    for (Index j = 0; j < a.cols(); ++j) {
      const double x = a(i, j);
      const double y = b(i, j);
      if (x != y && !(std::abs(x - y) <= kImageRounding * std::min(std::abs(x), std::abs(y)))) return false;
    }
  }
  return true;
}

/// Whether a field is even in x1 and in x2, up to rounding: one of two images says it of both.
bool is_mirrored(const Grid& grid, const ArrayXd& field) {
  const ConstComponent values(field.data(), grid.n1, grid.n2);
  const Index rows = grid.n1 / 2;
  const Index columns = grid.n2 / 2;
  return same(values.topRows(rows), values.bottomRows(rows).colwise().reverse()) &&
         same(values.leftCols(columns), values.rightCols(columns).rowwise().reverse());
}

/// Empty rows on each side, the smaller of the two counts; all but one if the field is empty.
template <typename Occupied>
Index empty_margin(Index count, const Occupied& occupied) {
  Index margin = 0;
  while (2 * (margin + 1) < count && !occupied(margin) && !occupied(count - 1 - margin)) ++margin;
  return margin;
}

Grid trimmed_grid(const Grid& grid, const ArrayXd& contact) {
  const ConstComponent field(contact.data(), grid.n1, grid.n2);
  const Index rows = empty_margin(grid.n1, [&](Index i) { return (field.row(i) > 0.0).any(); });
  const Index columns = empty_margin(grid.n2, [&](Index j) { return (field.col(j) > 0.0).any(); });
  return {grid.n1 - 2 * rows, grid.n2 - 2 * columns, grid.h1, grid.h2, false, grid.ranks};
}

/// The middle part of a field, component by component.
ArrayXd middle(const Grid& whole, const Grid& part, const ArrayXd& field) {
  const Index components = field.size() / whole.cells();
  ArrayXd result(components * part.cells());
  for (Index c = 0; c < components; ++c) {
    const ConstComponent from(field.data() + c * whole.cells(), whole.n1, whole.n2);
    MutableComponent(result.data() + c * part.cells(), part.n1, part.n2) =
        from.block((whole.n1 - part.n1) / 2, (whole.n2 - part.n2) / 2, part.n1, part.n2);
  }
  return result;
}

ArrayXd padded(const Grid& whole, const Grid& part, const ArrayXd& field) {
  const Index components = field.size() / part.cells();
  ArrayXd result = ArrayXd::Zero(components * whole.cells());
  for (Index c = 0; c < components; ++c) {
    const ConstComponent from(field.data() + c * part.cells(), part.n1, part.n2);
    MutableComponent(result.data() + c * whole.cells(), whole.n1, whole.n2)
        .block((whole.n1 - part.n1) / 2, (whole.n2 - part.n2) / 2, part.n1, part.n2) = from;
  }
  return result;
}

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

Reduction::Reduction(const Grid& grid, const ArrayXd& contact)
    : whole_(grid), trimmed_(trimmed_grid(grid, contact)), grid_(trimmed_) {}

Reduction::Reduction(const Grid& grid, const ArrayXd& shape, const ArrayXd& contact) : Reduction(grid, contact) {
  if (trimmed_.n1 % 2 != 0 || trimmed_.n2 % 2 != 0) return;  // an axis would cut cells in two
  const ArrayXd part = middle(whole_, trimmed_, shape);
  if (!is_mirrored(trimmed_, part)) return;
  grid_ = quadrant_of(trimmed_);
  const auto corner = ConstComponent(part.data(), trimmed_.n1, trimmed_.n2).topLeftCorner(grid_.n1, grid_.n2);
  diagonal_ = grid_.n1 == grid_.n2 && grid_.h1 == grid_.h2 && same(corner, corner.transpose());
}

ArrayXd Reduction::restricted(ArrayXd field) const {
  if (field.size() == 0) return field;
  if (trimmed()) field = middle(whole_, trimmed_, field);
  return quadrant() ? restrict_to_quadrant(trimmed_, field) : std::move(field);
}

ArrayXd Reduction::expanded(ArrayXd field, const Symmetry& symmetry) const {
  if (quadrant()) field = unfold(grid_, field, symmetry);
  if (trimmed()) field = padded(whole_, trimmed_, field);
  return field;
}

bool is_half_turn_symmetric(const Grid& grid, const ArrayXd& field) {
  const ConstComponent values(field.data(), 1, field.size());
  const Index half = field.size() / 2;
  return is_mirrored(grid, field) || same(values.leftCols(half), values.rightCols(half).rowwise().reverse());
}

ArrayXd half_turn_symmetrised(const ArrayXd& pressure) { return 0.5 * (pressure + pressure.reverse()); }

bool turns_into_itself(const ArrayXd& field) {
  const Index cells = field.size() / 2;
  const auto apart = [](const auto& component) { return (component + component.reverse()).abs().maxCoeff(); };
  return cells == 0 ||
         std::max(apart(field.head(cells)), apart(field.tail(cells))) <= kTransformRounding * field.abs().maxCoeff();
}

void turn_into_itself(ArrayXd& field) {
  const Index cells = field.size() / 2;
  for (auto component : {field.head(cells), field.tail(cells)}) {
    for (Index i = 0, image = cells - 1; i <= image; ++i, --image) {
      const double half = 0.5 * (component[i] - component[image]);
      component[image] = -half;
      component[i] = half;
    }
  }
}

ArrayXd symmetrised(const Grid& grid, const ArrayXd& pressure) {
  if (grid.n1 != grid.n2) throw std::invalid_argument("the diagonal of a grid that is not square");
  const ConstComponent field(pressure.data(), grid.n1, grid.n2);
  ArrayXd result(pressure.size());
  MutableComponent(result.data(), grid.n1, grid.n2) = 0.5 * (field + field.transpose());
  return result;
}

}  // namespace slipstick::solver
