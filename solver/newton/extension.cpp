#include "solver/newton/extension.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "solver/grid/threads.hpp"

namespace slipstick::solver {
namespace {

/// Of a cell's neighbours along each axis, from the next one on.
constexpr std::array<double, 2> kNeighbours{0.5, 0.25};
constexpr Index kReach = kNeighbours.size();
/// Beside the neighbours' weights: what lets the continuation fade where few of them are free.
constexpr double kFade = 0.5;

}  // namespace

template <typename Real>
Extension<Real>::Extension(const Grid& grid)
    : grid_(grid),
      weight_(grid.cells()),
      work_(grid.cells()),
      threads_(ThreadPool::available()),
      column_sums_(Field::Zero((grid.n2 + 2 * kReach) * threads_)) {}

/// Row by row the sum over neighbours of a field, which is zero beyond the grid.
template <typename Real>
template <typename Row>
void Extension<Real>::spread(Field& in, const Row& take_row) {
  const RowBands bands(grid_.n1);
  Ranks::gather_beside(std::span<Real>(in.data(), static_cast<std::size_t>(in.size())), grid_.n1,
                       bands.rows_of_rank(), kReach);
  const auto row = [&](Index i) { return in.segment(i * grid_.n2, grid_.n2); };
  const Share own = bands.own_rows();
  in_parts(threads_, own.count(), [&](int thread, Index first, Index last) {
    auto sums = column_sums_.segment(thread * (grid_.n2 + 2 * kReach), grid_.n2 + 2 * kReach);
    auto inner = sums.segment(kReach, grid_.n2);
    const auto shifted = [&](Index k) { return sums.segment(kReach + k, grid_.n2); };
    for (Index i = own.first + first; i < own.first + last; ++i) {
      inner = row(i);
      for (Index k = 1; k <= kReach; ++k) {
        const auto weight = static_cast<Real>(kNeighbours[static_cast<std::size_t>(k - 1)]);
        if (i >= k) inner += weight * row(i - k);
        if (i + k < grid_.n1) inner += weight * row(i + k);
      }
      static_assert(kReach == 2);
      take_row(i * grid_.n2, inner + static_cast<Real>(kNeighbours[0]) * (shifted(-1) + shifted(1)) +
                                 static_cast<Real>(kNeighbours[1]) * (shifted(-2) + shifted(2)));
    }
  });
}

template <typename Real>
void Extension<Real>::prepare(Field& free) {
  spread(free, [&](Index first, const auto& sums) {
    const auto is_free = free.segment(first, grid_.n2);
    weight_.segment(first, grid_.n2) = (Real(1) - is_free) / (sums + static_cast<Real>(kFade));
  });
}

template <typename Real>
void Extension<Real>::extend(Field& y) {
  spread(y, [&](Index first, const auto& sums) {
    work_.segment(first, grid_.n2) = weight_.segment(first, grid_.n2) * sums;
  });
  const Share rows = RowBands(grid_.n1).own_rows();
  const Index first = rows.first * grid_.n2;
  const Index count = rows.count() * grid_.n2;
  y.segment(first, count) += work_.segment(first, count);
}

template <typename Real>
void Extension<Real>::gather(Field& y) {
  const Share rows = RowBands(grid_.n1).own_rows();
  const Index start = rows.first * grid_.n2;
  const Index count = rows.count() * grid_.n2;
  work_.segment(start, count) = weight_.segment(start, count) * y.segment(start, count);
  spread(work_, [&](Index first, const auto& sums) { y.segment(first, grid_.n2) += sums; });
}

template <typename Real>
void Extension<Real>::hand_on(const Sweep& cells, const Field& free, Eigen::ArrayXd& p, Field& stays,
                              Field& leaves) {
  clear(cells, stays);
  clear(cells, leaves);
  const auto count = cells.sum<Index>([&](Index first, Index last, Index& sum) {
    for (Index i = first; i < last; ++i) {
      if (free[i] != Real(0) && p[i] > 0.0) {
        stays[i] = Real(1);
      } else if (p[i] != 0.0) {
        leaves[i] = static_cast<Real>(std::exchange(p[i], 0.0));
        ++sum;
      }
    }
  });
  if (count == 0) return;
  prepare(stays);
  gather(leaves);
  cells.each([&](Index first, Index last) {
    for (Index i = first; i < last; ++i) p[i] += static_cast<double>(stays[i] * leaves[i]);
  });
}

template class Extension<double>;
template class Extension<float>;

}  // namespace slipstick::solver
