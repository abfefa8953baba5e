#include "solver/newton/extension.hpp"

#include <algorithm>
#include <utility>

#include "solver/grid/threads.hpp"

namespace slipstick::solver {
namespace {

/// A cell's neighbours along each axis, up to this far off, count each for this part of the one nearer to it.
/// Spots of a finer mesh have more cells: at 1,024, half of them in contact, a reach of two takes two fifths
/// more applications. On coarse meshes more costs more than it spares.
constexpr Index kLeastReach = 2;
constexpr Index kMostReach = 8;
constexpr Index kSidesOfReach = 64;
constexpr double kNearest = 0.5;
constexpr double kDecay = 0.7;
/// Beside the neighbours' weights: what lets the continuation fade where few of them are free.
/// Of 0.5, contacts of few cells take an eighth more applications.
constexpr double kFade = 1.0;

}  // namespace

template <typename Real>
Extension<Real>::Extension(const Grid& grid)
    : grid_(grid),
      reach_(std::clamp(std::min(grid.n1, grid.n2) / kSidesOfReach, kLeastReach, kMostReach)),
      weight_(grid.cells()),
      work_(grid.cells()),
      zeros_(Field::Zero(grid.n2)) {
  for (int thread = 0; thread < ThreadPool::available(); ++thread) {
    column_sums_.push_back(Field::Zero(grid.n2 + 2 * reach_));
    sums_.emplace_back(grid.n2);
  }
}

/// Row by row the sum over neighbours of a field, which is zero beyond the grid.
template <typename Real>
template <typename Row>
void Extension<Real>::spread(Field& in, const Row& take_row) {
  const RowBands bands(grid_.n1);
  Ranks::gather_beside(std::span<Real>(in.data(), static_cast<std::size_t>(in.size())), grid_.n1,
                       bands.rows_of_rank(), reach_);
  const Share own = bands.own_rows();
  in_parts(static_cast<int>(sums_.size()), own.count(), [&](int thread, Index first, Index last) {
    Field& column_sums = column_sums_[static_cast<std::size_t>(thread)];
    Field& sums = sums_[static_cast<std::size_t>(thread)];
    const auto inner = [&](Index k) { return column_sums.segment(reach_ + k, grid_.n2); };
    const auto add_beside = [&](const auto& at, auto&& sum) {
      Real weight = kNearest;
      for (Index k = 1; k <= reach_; ++k, weight *= Real(kDecay)) sum += weight * (at(-k) + at(k));
    };
    for (Index i = own.first + first; i < own.first + last; ++i) {
      const auto row = [&](Index k) {
        const bool inside = 0 <= i + k && i + k < grid_.n1;
        return inside ? in.segment((i + k) * grid_.n2, grid_.n2) : zeros_.segment(0, grid_.n2);
      };
      inner(0) = row(0);
      add_beside(row, inner(0));
      sums = inner(0);
      add_beside(inner, sums);
      take_row(i * grid_.n2, sums);
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
