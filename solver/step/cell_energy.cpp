#include "solver/step/cell_energy.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "solver/grid/grid_transfer.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

constexpr Index kNear = 5;  // cells along each side: one, its neighbours and theirs

/// Mean displacements of each of these cells by the middle one's traction along an axis, over parts of a
/// cell. without_middle: over 8 of 9.
ArrayXd near_means(const Elasticity& elasticity, const Grid& cells, const BlockKernel& kernel, Index axis,
                   Index components, Index parts, bool without_middle) {
  const Grid fine = divided(cells, parts);
  ArrayXd q = ArrayXd::Zero(components * cells.cells());
  q[axis * cells.cells() + cells.cells() / 2] = 1.0;
  ArrayXd u = elasticity.make(fine, kernel)->applied(spread_to(fine, cells, q));
  if (without_middle) {
    for (Index k = 0; k < u.size(); ++k) {
      const bool middle = (k / fine.n2) % parts == parts / 2 && k % fine.n2 % parts == parts / 2;
      u[k] *= middle ? 0.0 : 9.0 / 8.0;
    }
  }
  return restrict_to(cells, fine, u);
}

/// The difference of two rules. A constant traction on the whole plane moves all points by the
/// same, so the cell itself has what makes the sum of each component zero.
ArrayXd difference(const ArrayXd& means, const ArrayXd& rule) {
  ArrayXd found = means - rule;
  for (Index k = 0; k < found.size(); k += kNear * kNear)
    found[k + kNear * kNear / 2] -= found.segment(k, kNear * kNear).sum();
  return found;
}

using Rows = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A component with `reach` more rows and columns on each side: mirrored across a quadrant's axes, else zero.
Rows padded(const Grid& grid, const ArrayXd& q, std::size_t component, Parity parity, Index reach) {
  const Eigen::Map<const Rows> inside(q.data() + static_cast<Index>(component) * grid.cells(), grid.n1, grid.n2);
  Rows all = Rows::Zero(grid.n1 + 2 * reach, grid.n2 + 2 * reach);
  all.block(reach, reach, grid.n1, grid.n2) = inside;
  if (!grid.quadrant) return all;
  all.topRows(reach) = parity.x1 * all.middleRows(reach, reach).colwise().reverse();
  all.leftCols(reach) = parity.x2 * all.middleCols(reach, reach).rowwise().reverse();
  return all;
}

/// q.Dq/2 with coefficients D between neighbours: by_axis[c] are the displacements by component c.
double energy_of_neighbours(const Grid& grid, const ArrayXd& q, const std::vector<ArrayXd>& by_axis,
                            const Symmetry& symmetry) {
  const Index reach = kNear / 2;
  const double negligible = 1e-9 * by_axis.front().abs().maxCoeff();
  double sum = 0.0;
  for (std::size_t source = 0; source < by_axis.size(); ++source) {
    const Rows from = padded(grid, q, source, symmetry[source], reach);
    for (std::size_t c = 0; c < by_axis.size(); ++c) {
      const Eigen::Map<const Rows> to(q.data() + static_cast<Index>(c) * grid.cells(), grid.n1, grid.n2);
      for (Index o = 0; o < kNear * kNear; ++o) {
        const double d = by_axis[source][static_cast<Index>(c) * kNear * kNear + o];
        if (std::abs(d) <= negligible) continue;
        const Index row = 2 * reach - o / kNear;
        const Index column = 2 * reach - o % kNear;
        sum += d * (to * from.block(row, column, grid.n1, grid.n2)).sum();
      }
    }
  }
  return 0.5 * sum * grid.cell_area();
}

}  // namespace

Estimate missing_energy(const Elasticity& elasticity, const Grid& grid, const ArrayXd& q, const BlockKernel& kernel,
                        const Symmetry& symmetry) {
  const Grid cells{kNear, kNear, grid.h1, grid.h2};
  const auto components = static_cast<Index>(symmetry.size());
  std::vector<ArrayXd> found;
  std::vector<ArrayXd> by_fewer;
  for (Index axis = 0; axis < components; ++axis) {
    const auto means = [&](Index parts, bool without_middle = false) {
      return near_means(elasticity, cells, kernel, axis, components, parts, without_middle);
    };
    const ArrayXd rule = means(3, true);
    found.push_back(difference((9.0 * means(15) - means(5)) / 8.0, rule));  // errors go with 1/parts^2
    by_fewer.push_back(difference((9.0 * means(9) - means(3)) / 8.0, rule));
  }
  const double energy = energy_of_neighbours(grid, q, found, symmetry);
  return {energy, std::abs(energy - energy_of_neighbours(grid, q, by_fewer, symmetry))};
}

}  // namespace slipstick::solver
