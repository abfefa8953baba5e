#include "solver/newton/extension.hpp"

#include <algorithm>
#include <array>

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
      weight_(Field::Zero(grid.cells())),
      work_(grid.cells()),
      column_sums_(Field::Zero(grid.n2 + 2 * kReach)) {}

/// Row by row the sum over neighbours of a field, which is zero beyond the grid.
template <typename Real>
template <typename Row>
void Extension<Real>::spread(const Field& in, const Row& take_row) {
  const auto row = [&](Index i) { return in.segment(i * grid_.n2, grid_.n2); };
  auto inner = column_sums_.segment(kReach, grid_.n2);
  for (Index i = 0; i < grid_.n1; ++i) {
    inner = row(i);
    for (Index k = 1; k <= kReach; ++k) {
      const auto weight = static_cast<Real>(kNeighbours[static_cast<std::size_t>(k - 1)]);
      if (i >= k) inner += weight * row(i - k);
      if (i + k < grid_.n1) inner += weight * row(i + k);
    }
    const auto shifted = [&](Index k) { return column_sums_.segment(kReach + k, grid_.n2); };
    static_assert(kReach == 2);
    take_row(i * grid_.n2, inner + static_cast<Real>(kNeighbours[0]) * (shifted(-1) + shifted(1)) +
                               static_cast<Real>(kNeighbours[1]) * (shifted(-2) + shifted(2)));
  }
}

template <typename Real>
void Extension<Real>::prepare(const Field& free) {
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
  y += work_;
}

template <typename Real>
void Extension<Real>::gather(Field& y) {
  work_ = weight_ * y;
  spread(work_, [&](Index first, const auto& sums) { y.segment(first, grid_.n2) += sums; });
}

template class Extension<double>;
template class Extension<float>;

}  // namespace slipstick::solver
