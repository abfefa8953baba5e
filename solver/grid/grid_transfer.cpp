#include "solver/grid/grid_transfer.hpp"

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>

namespace slipstick::solver {
namespace {

using Weights = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// A grid with fewer cells than this along a side no longer resembles the contact.
constexpr Index kMinSideCells = 8;

/// Row i: the parts of coarse cell i that each fine cell covers.
Weights overlaps(Index coarse, Index fine) {
  Weights weights(coarse, fine);
  const double ratio = static_cast<double>(fine) / static_cast<double>(coarse);
  for (Index i = 0; i < coarse; ++i) {
    const double low = static_cast<double>(i) * ratio;
    const double high = static_cast<double>(i + 1) * ratio;
    for (auto j = static_cast<Index>(low); j < fine && static_cast<double>(j) < high; ++j) {
      const double covered = std::min(high, static_cast<double>(j + 1)) - std::max(low, static_cast<double>(j));
      if (covered > 0.0) weights.insert(i, j) = covered / ratio;
    }
  }
  return weights;
}

/// Row i: weights of the coarse centres next to fine centre i.
Weights interpolation(Index fine, Index coarse, bool mirrored, int parity) {
  Weights weights(fine, coarse);
  const double ratio = static_cast<double>(coarse) / static_cast<double>(fine);
  for (Index i = 0; i < fine; ++i) {
    const double x = (static_cast<double>(i) + 0.5) * ratio - 0.5;  // in coarse cells from the first centre
    const auto left = static_cast<Index>(std::floor(x));
    const double part = x - static_cast<double>(left);
    const auto add = [&](Index j, double weight) {
      if (j < 0) weight *= mirrored ? parity : 1;
      weights.coeffRef(i, j < 0 ? 0 : std::min(j, coarse - 1)) += weight;
    };
    add(left, 1.0 - part);
    add(left + 1, part);
  }
  return weights;
}

/// Row i: the fractions of cell i of the row `to` that each cell of the row `from` covers; the outermost cells of
/// `from` extend to infinity. ratio: cell size of `to` over that of `from`; shift: middle of `to`, in cells of `from`.
Weights coverings(Index to, Index from, double ratio, double shift) {
  constexpr double kSamePlace = 1e-6;  // of a cell: positions that a file holds are rounded
  const auto place = [&](Index i) {
    const double from_middle = (static_cast<double>(i) - 0.5 * static_cast<double>(to)) * ratio + shift;
    const double x = from_middle + 0.5 * static_cast<double>(from);
    const double side = std::round(x);
    return std::clamp(std::abs(x - side) <= kSamePlace ? side : x, 0.0, static_cast<double>(from));
  };
  Weights weights(to, from);
  for (Index i = 0; i < to; ++i) {
    const double low = place(i);
    const double high = place(i + 1);
    if (!(high > low)) weights.insert(i, low > 0.0 ? from - 1 : 0) = 1.0;
    for (auto j = static_cast<Index>(low); static_cast<double>(j) < high; ++j) {
      const auto left = static_cast<double>(j);
      weights.insert(i, j) = (std::min(high, left + 1.0) - std::max(low, left)) / (high - low);
    }
  }
  return weights;
}

/// out = along1 in along2^T, one row after the other: only a row of along1 in is kept.
void transform(const Weights& along1, const Weights& along2, const double* in, double* out) {
  Eigen::VectorXd row(along2.cols());
  for (Index i = 0; i < along1.rows(); ++i) {
    row.setZero();
    for (Weights::InnerIterator weight(along1, i); weight; ++weight)
      row += weight.value() * Eigen::Map<const Eigen::VectorXd>(in + weight.index() * row.size(), row.size());
    Eigen::Map<Eigen::VectorXd>(out + i * along2.rows(), along2.rows()).noalias() = along2 * row;
  }
}

}  // namespace

Grid coarser(const Grid& grid) {
  const auto fewer = [](Index n) { return (n + 1) / 2; };
  const auto ratio = [&](Index n) { return static_cast<double>(n) / static_cast<double>(fewer(n)); };
  return {fewer(grid.n1),           fewer(grid.n2), grid.h1 * ratio(grid.n1),
          grid.h2 * ratio(grid.n2), grid.quadrant,  grid.ranks};
}

bool can_coarsen(const Grid& grid) {
  const Index fewest = std::min(coarser(grid).n1, coarser(grid).n2) * (grid.quadrant ? 2 : 1);
  return fewest >= kMinSideCells;
}

Grid divided(const Grid& grid, Index parts) {
  const auto count = static_cast<double>(parts);
  return {parts * grid.n1, parts * grid.n2, grid.h1 / count, grid.h2 / count, grid.quadrant, grid.ranks};
}

Eigen::ArrayXd spread_to(const Grid& fine, const Grid& coarse, const Eigen::ArrayXd& field) {
  const Index parts = fine.n1 / coarse.n1;
  const Index rows = field.size() / coarse.n2;  // of all components
  Eigen::ArrayXd result(rows * parts * fine.n2);
  for (Index i = 0; i < rows * parts; ++i) {
    for (Index j = 0; j < fine.n2; ++j) result[i * fine.n2 + j] = field[(i / parts) * coarse.n2 + j / parts];
  }
  return result;
}

Eigen::ArrayXd restrict_to(const Grid& coarse, const Grid& fine, const Eigen::ArrayXd& field) {
  const Weights along1 = overlaps(coarse.n1, fine.n1);
  const Weights along2 = overlaps(coarse.n2, fine.n2);
  const Index components = field.size() / fine.cells();
  Eigen::ArrayXd result(components * coarse.cells());
  for (Index c = 0; c < components; ++c) {
    transform(along1, along2, field.data() + c * fine.cells(), result.data() + c * coarse.cells());
  }
  return result;
}

Eigen::ArrayXd means_on(const Grid& to, const Grid& from, const Eigen::ArrayXd& field,
                        const std::array<double, 2>& centre) {
  Eigen::ArrayXd result(to.cells());
  transform(coverings(to.n1, from.n1, to.h1 / from.h1, centre[0] / from.h1),
            coverings(to.n2, from.n2, to.h2 / from.h2, centre[1] / from.h2), field.data(), result.data());
  return result;
}

Eigen::ArrayXd prolong_to(const Grid& fine, const Grid& coarse, const Eigen::ArrayXd& field,
                          std::span<const Parity> parities) {
  Eigen::ArrayXd result(static_cast<Index>(parities.size()) * fine.cells());
  for (std::size_t c = 0; c < parities.size(); ++c) {
    const Weights along1 = interpolation(fine.n1, coarse.n1, fine.quadrant, parities[c].x1);
    const Weights along2 = interpolation(fine.n2, coarse.n2, fine.quadrant, parities[c].x2);
    const auto component = static_cast<Index>(c);
    transform(along1, along2, field.data() + component * coarse.cells(), result.data() + component * fine.cells());
  }
  return result;
}

}  // namespace slipstick::solver
