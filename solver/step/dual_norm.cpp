#include "solver/step/dual_norm.hpp"

#include <cmath>

namespace slipstick::solver {
namespace {

using Rows = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Sum of the squared differences of rows that are `apart` rows from each other; outside there are zeros, or
/// a mirror before the first row if parity is not zero.
double squared_differences(const auto& rows, Index apart, int parity) {
  const Index others = rows.rows() - apart;
  const double inside = (rows.bottomRows(others) - rows.topRows(others)).square().sum();
  const double after = rows.bottomRows(apart).square().sum();
  if (parity == 0) return inside + after + rows.topRows(apart).square().sum();
  const auto before = parity * rows.topRows(apart).colwise().reverse();
  // A difference across the mirror belongs to two quadrants.
  return inside + after + 0.5 * (rows.topRows(apart) - before).square().sum();
}

/// The integral of |grad v|^2.
double gradient_squared(const Grid& grid, const Eigen::ArrayXd& v, std::span<const Parity> parities, Index apart) {
  double sum = 0.0;
  for (std::size_t c = 0; c < parities.size(); ++c) {
    const Eigen::Map<const Rows> rows(v.data() + static_cast<Index>(c) * grid.cells(), grid.n1, grid.n2);
    const auto [x1, x2] = grid.quadrant ? parities[c] : Parity{0, 0};
    sum += squared_differences(rows, apart, x1) / (grid.h1 * grid.h1) +
           squared_differences(rows.transpose(), apart, x2) / (grid.h2 * grid.h2);
  }
  return sum * grid.cell_area() / static_cast<double>(apart * apart);
}

}  // namespace

Estimate dual_norm_squared(const Grid& grid, const Eigen::ArrayXd& v, std::span<const Parity> parities,
                           double compliance) {
  const double square = v.square().sum() * grid.cell_area();
  const auto by = [&](Index apart) {
    return std::sqrt(square * gradient_squared(grid, v, parities, apart)) / compliance;
  };
  const double found = by(1);
  return {found, std::abs(found - by(2))};
}

}  // namespace slipstick::solver
