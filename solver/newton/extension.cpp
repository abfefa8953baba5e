#include "solver/newton/extension.hpp"

#include <algorithm>
#include <utility>

namespace slipstick::solver {
namespace {

/// A cell's neighbours along each axis, up to this far off, count each for this part of the one nearer to it.
/// Spots of a finer mesh have more cells: at 1,024, half of them in contact, a reach of two takes two fifths
/// more applications. On coarse meshes more costs more than it spares.
constexpr Index kMinReach = 2;
constexpr Index kMaxReach = 8;
constexpr Index kSidesOfReach = 64;
constexpr double kNearest = 0.5;
constexpr double kDecay = 0.7;
/// Beside the neighbours' weights: what lets the continuation fade where few of them are free.
/// With 0.5, contacts of few cells take an eighth more applications.
constexpr double kFade = 1.0;

/// Cells of a row that are mixed together: the neighbours of one are in the blocks beside it at most.
constexpr Index kBlock = 16;
static_assert(kBlock >= kMaxReach);
/// Cells of a row that are summed at once.
constexpr Index kChunk = 256;

}  // namespace

Extension::Extension(const Grid& grid)
    : grid_(grid),
      reach_(std::clamp(std::min(grid.n1, grid.n2) / kSidesOfReach, kMinReach, kMaxReach)),
      weight_(grid.cells()),
      work_(grid.cells()),
      mixed_(grid),
      zeros_(Field::Zero(grid.n2)) {}

/// Counts free cells near each block; what is beyond the grid is not free.
void Extension::find_mixed(const Field& free) {
  const Share own = own_rows(grid_);
  const Index blocks = (grid_.n2 + kBlock - 1) / kBlock;
  const Index rows_near = 2 * reach_ + 1;
  const auto cells_of = [&](auto& field, Index row, Index block) {
    const Index first = block * kBlock;
    return field.segment(row * grid_.n2 + first, std::min(kBlock, grid_.n2 - first));
  };
  Eigen::ArrayXXi counts = Eigen::ArrayXXi::Zero(blocks + 2, own.count() + 2 * reach_);
  const Index row_0 = own.first - reach_;
  for (Index row = std::max<Index>(row_0, 0); row < std::min(own.last + reach_, grid_.n1); ++row) {
    for (Index block = 0; block < blocks; ++block) {
      counts(block + 1, row - row_0) = static_cast<int>(cells_of(free, row, block).sum());
    }
  }
  Eigen::ArrayXi near(blocks + 2);
  for (Index row = own.first; row < own.last; ++row) {
    near = counts.middleCols(row - own.first, rows_near).rowwise().sum();
    for (Index block = 0; block < blocks; ++block) {
      const int count = near.template segment<3>(block).sum();
      cells_of(weight_, row, block).setConstant(count > 0 && count < 3 * kBlock * rows_near ? 1.0 : 0.0);
    }
  }
  mixed_.assign(grid_.cells(), [&](Index cell) { return weight_[cell] != 0.0; });
}

/// take(first, sums) for cells of mixed_: the sums over neighbours of a field's component, which begins at
/// `component` and is zero beyond the grid.
template <typename Take>
void Extension::spread(const Field& in, Index component, const Take& take) const {
  using Line = Eigen::Array<double, kChunk + 2 * kMaxReach, 1>;
  const auto add_beside = [&](const auto& at, auto&& sum) {
    double weight = kNearest;
    for (Index k = 1; k <= reach_; ++k, weight *= kDecay) sum += weight * (at(-k) + at(k));
  };
  const auto spread_in = [&](Index row, Index first, Index last) {
    const Index left = std::max<Index>(first - reach_, 0);
    const Index count = std::min(last + reach_, grid_.n2) - left;
    const auto line = [&](Index k) {
      const bool inside = 0 <= row + k && row + k < grid_.n1;
      return inside ? in.segment(component + (row + k) * grid_.n2 + left, count) : zeros_.segment(0, count);
    };
    Line column_sums;
    column_sums.head(last - first + 2 * reach_).setZero();
    auto within = column_sums.segment(left - (first - reach_), count);
    within = line(0);
    add_beside(line, within);
    const auto shifted = [&](Index k) { return column_sums.segment(reach_ + k, last - first); };
    Line sums;
    sums.head(last - first) = shifted(0);
    add_beside(shifted, sums.head(last - first));
    take(row * grid_.n2 + first, sums.head(last - first));
  };
  mixed_.each([&](Index first, Index last) {
    const Index row = first / grid_.n2;
    for (Index start = first; start < last; start += kChunk) {
      spread_in(row, start - row * grid_.n2, std::min(start + kChunk, last) - row * grid_.n2);
    }
  });
}

void Extension::prepare(Field& free) {
  share_rows_beside(grid_, free, reach_);
  find_mixed(free);
  clear(mixed_, work_);
  spread(free, 0, [&](Index first, const auto& sums) {
    const auto is_free = free.segment(first, sums.size());
    weight_.segment(first, sums.size()) = (1.0 - is_free) / (sums + kFade);
  });
}

void Extension::extend(Field& y) {
  share_rows_beside(grid_, y, reach_);
  for (Index component = 0; component < y.size(); component += grid_.cells()) {
    spread(y, component, [&](Index first, const auto& sums) {
      work_.segment(first, sums.size()) = weight_.segment(first, sums.size()) * sums;
    });
    mixed_.each([&](Index first, Index last) {
      y.segment(component + first, last - first) += work_.segment(first, last - first);
    });
  }
}

void Extension::collect(Field& y) {
  for (Index component = 0; component < y.size(); component += grid_.cells()) {
    mixed_.each([&](Index first, Index last) {
      work_.segment(first, last - first) =
          weight_.segment(first, last - first) * y.segment(component + first, last - first);
    });
    share_rows_beside(grid_, work_, reach_);
    spread(work_, 0,
           [&](Index first, const auto& sums) { y.segment(component + first, sums.size()) += sums; });
  }
}

void Extension::hand_on(const Sweep& cells, const Field& free, Eigen::ArrayXd& p, Field& stays,
                        Field& leaves) {
  clear(cells, stays);
  clear(cells, leaves);
  const auto count = cells.sum<Index>([&](Index first, Index last, Index& sum) {
    for (Index i = first; i < last; ++i) {
      if (free[i] != 0.0 && p[i] > 0.0) {
        stays[i] = 1.0;
      } else if (p[i] != 0.0) {
        leaves[i] = std::exchange(p[i], 0.0);
        ++sum;
      }
    }
  });
  if (count == 0) return;
  prepare(stays);
  collect(leaves);
  cells.each([&](Index first, Index last) {
    for (Index i = first; i < last; ++i) p[i] += static_cast<double>(stays[i] * leaves[i]);
  });
}

}  // namespace slipstick::solver
