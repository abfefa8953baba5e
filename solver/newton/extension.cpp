#include "solver/newton/extension.hpp"

#include "solver/grid/threads.hpp"
#include "solver/newton/conjugate_gradients.hpp"
#include "solver/newton/tangent_space.hpp"

namespace slipstick::solver {
namespace {

/// Weights of a cell's neighbours along each axis, the nearer one first; the cell itself has one.
constexpr std::array<double, 2> kNear{0.5, 0.35};
/// Cells of a block along each axis, and the part that cells in it count for: the square of the distance.
constexpr Index kSide = 4;
constexpr double kFar = 1.0 / 16.0;
/// Added to the sum of weights, so that the continuation fades where few neighbours are free.
constexpr double kFade = 1.0;
/// Rows of a block of blocks; the rows of a rank are whole blocks of blocks.
constexpr Index kCoarsest = kSide * kSide;
static_assert(kRowsOfBand % kCoarsest == 0);
/// On shorter grids nearly all cells are within reach, and all count as mixed without a search.
constexpr Index kAllMixed = 4 * kCoarsest;

using Row = Eigen::Map<const Eigen::ArrayXd>;

Index blocks_of(Index n) { return (n + kSide - 1) / kSide; }

/// Adds cells, from the first one of a block on, to the sums of their blocks.
void add_to_blocks(const Row& cells, double* sums) {
  const Index whole = cells.size() / kSide * kSide;
  for (Index j = 0; j < whole; j += kSide) sums[j / kSide] += cells.segment<kSide>(j).sum();
  if (whole < cells.size()) sums[whole / kSide] += cells.tail(cells.size() - whole).sum();
}

}  // namespace

Extension::Extension(const Grid& grid, Index components, std::span<double> memory)
    : grid_(grid),
      weights_((components == 1 ? 1 : 3) * grid.cells()),
      own_work_(static_cast<Index>(memory.size()) < components * grid.cells() ? components * grid.cells() : 0),
      work_(own_work_.size() > 0 ? own_work_.data() : memory.data(), components * grid.cells()),
      mixed_(Sweep::whole(grid)) {
  Index n1 = grid.n1;
  Index n2 = grid.n2;
  for (Level& level : blocks_) {
    level.n1 = n1 = blocks_of(n1);
    level.n2 = n2 = blocks_of(n2);
    level.sums.resize(components * n1 * n2);
    level.means.resize(components * n1 * n2);
  }
}

/// The sums over the neighbours of [first, last) in a row of a field, which is zero beyond its n1 rows of n2.
auto Extension::near_sums(const double* in, Index n1, Index n2, Index row, Index first, Index last) -> Line {
  static const Line kZeros = Line::Zero();
  const Index left = std::max<Index>(first - kReach, 0);
  const Index count = std::min(last + kReach, n2) - left;
  const auto line = [&](Index k) {
    const bool inside = 0 <= row + k && row + k < n1;
    return Row(inside ? in + (row + k) * n2 + left : kZeros.data(), count);
  };
  const auto with_neighbours = [](const auto& at) {
    return at(0) + kNear[0] * (at(-1) + at(1)) + kNear[1] * (at(-2) + at(2));
  };
  Line columns;
  columns.head(last - first + 2 * kReach).setZero();
  columns.segment(left - (first - kReach), count) = with_neighbours(line);
  Line sums;
  sums.head(last - first) = with_neighbours([&](Index k) { return columns.segment(kReach + k, last - first); });
  return sums;
}

/// The sums of a component over all blocks, of its values in mixed_.
void Extension::fill_blocks(const double* in, Index component) {
  Level& fine = blocks_[0];
  Level& coarse = blocks_[1];
  double* const sums = fine.sums.data() + component * fine.n1 * fine.n2;
  const Index of_rank = rows_of_rank(grid_.n1, grid_.ranks) / kSide;
  std::fill_n(sums, fine.n1 * fine.n2, 0.0);
  mixed_.each([&](Index first, Index last) {
    const Index row = first / grid_.n2;
    const Index column = first - row * grid_.n2;
    add_to_blocks(Row(in + first, last - first), sums + row / kSide * fine.n2 + column / kSide);
  });
  if (grid_.ranks.several())
    grid_.ranks.gather(std::span(sums, static_cast<std::size_t>(fine.n1 * fine.n2)), fine.n1, of_rank);
  double* const above = coarse.sums.data() + component * coarse.n1 * coarse.n2;
  std::fill_n(above, coarse.n1 * coarse.n2, 0.0);
  for (Index row = 0; row < fine.n1; ++row)
    add_to_blocks(Row(sums + row * fine.n2, fine.n2), above + row / kSide * coarse.n2);
}

/// Adds the means of their blocks to the sums of `count` cells of a row, from the first one of a block on.
void Extension::add_means(const Level& blocks, Index component, Index row, Index column, Index count, Line& sums) {
  const double* const means = blocks.means.data() + (component * blocks.n1 + row / kSide) * blocks.n2 + column / kSide;
  const Index whole = count / kSide * kSide;
  for (Index j = 0; j < whole; j += kSide) sums.segment<kSide>(j) += means[j / kSide];
  if (whole < count) sums.segment(whole, count - whole) += means[whole / kSide];
}

/// The weighted sums of nearby blocks, first for the coarse level.
void Extension::spread_blocks(Index component) {
  const auto spread_row = [&](Level& level, const Level* above, Index row) {
    const Index from = component * level.n1 * level.n2;
    for (Index start = 0; start < level.n2; start += kChunk) {
      const Index count = std::min(kChunk, level.n2 - start);
      Line sums = near_sums(level.sums.data() + from, level.n1, level.n2, row, start, start + count);
      if (above != nullptr) add_means(*above, component, row, start, count, sums);
      level.means.segment(from + row * level.n2 + start, count) = kFar * sums.head(count);
    }
  };
  for (Index row = 0; row < blocks_[1].n1; ++row) spread_row(blocks_[1], nullptr, row);
  const IndexRange own = own_rows(grid_);
  const Index first_block = own.first / kSide;
  in_parts(ThreadPool::available(), blocks_of(own.last) - first_block, [&](int, Index first, Index last) {
    for (Index row = first; row < last; ++row) spread_row(blocks_[0], &blocks_[1], first_block + row);
  });
}

/// take(first, count, sums) for the cells of mixed_, with the weighted sums of each component over nearby
/// cells. The field is zero outside the grid, and is read in mixed_ and around_.
template <std::size_t components, typename Take>
void Extension::spread(const double* in, const Take& take) {
  for (std::size_t c = 0; c < components; ++c) {
    fill_blocks(in + static_cast<Index>(c) * grid_.cells(), static_cast<Index>(c));
    spread_blocks(static_cast<Index>(c));
  }
  mixed_.each([&](Index first, Index last) {
    const Index row = first / grid_.n2;
    std::array<Line, components> sums;
    for (Index start = first; start < last; start += kChunk) {
      const Index count = std::min(kChunk, last - start);
      const Index column = start - row * grid_.n2;
      for (std::size_t c = 0; c < components; ++c) {
        const auto component = static_cast<Index>(c);
        sums[c] = near_sums(in + component * grid_.cells(), grid_.n1, grid_.n2, row, column, column + count);
        add_means(blocks_[0], component, row, column, count, sums[c]);
      }
      take(start, count, sums);
    }
  });
}

/// mixed_: the coarsest blocks within reach of a free cell and of a cell that is not, or not wholly, free; around_.
template <typename IsFree>
void Extension::find_mixed(const IsFree& is_free, bool free_is_whole) {
  if (std::max(grid_.n1, grid_.n2) <= kAllMixed) return;
  mixed_ = Sweep::whole(grid_);
  const auto reached = [&](double free, double other) -> Eigen::ArrayXXd {
    in_own_rows(grid_, grid_.cells(), [&](Index first, Index count) {
      for (Index i = first; i < first + count; ++i) work_[i] = is_free(i) ? free : other;
    });
    fill_blocks(work_.data(), 0);
    spread_blocks(0);
    return Eigen::Map<const Eigen::ArrayXXd>(blocks_[1].means.data(), blocks_[1].n2, blocks_[1].n1);
  };
  const Eigen::ArrayXXd from = reached(1.0, 0.0);
  const Eigen::ArrayXXd to = reached(free_is_whole ? 0.0 : 1.0, 1.0);
  constexpr int kAround = 1, kMixed = 2;
  Eigen::ArrayXXi framed = Eigen::ArrayXXi::Zero(from.rows() + 2, from.cols() + 2);
  framed.block(1, 1, from.rows(), from.cols()) = (from > 0.0 && to > 0.0).cast<int>();
  const Eigen::ArrayXXi kinds = Eigen::ArrayXXi::NullaryExpr(from.rows(), from.cols(), [&](Index i, Index j) {
    return framed(i + 1, j + 1) > 0 ? kMixed : framed.block<3, 3>(i, j).maxCoeff() * kAround;
  });
  for (const int kind : {kAround, kMixed}) {
    Sweep& cells = kind == kMixed ? mixed_ : around_;
    cells = Sweep(grid_);
    Index row = 0;
    cells.assign([&](Index cell) {  // cells come in order
      while (cell >= (row + 1) * grid_.n2) ++row;
      return kinds((cell - row * grid_.n2) / kCoarsest, row / kCoarsest) == kind;
    });
  }
}

/// free_part(cell): the matrix of the free part of a cell's vector. weights(cell, near): the matrix that
/// multiplies sums at a cell, with near the sum of free parts nearby.
template <typename FreePart, typename Weights>
void Extension::prepare_with(const FreePart& free_part, const Weights& weights) {
  const Index n = grid_.cells();
  const auto entries = static_cast<std::size_t>(weights_.size() / n);
  for (std::size_t entry = 0; entry < entries; ++entry) {
    in_own_rows(grid_, n, [&](Index first, Index count) {
      for (Index i = first; i < first + count; ++i) work_[i] = free_part(i)[entry];
    });
    share_adjacent_rows(grid_, work_, kReach);
    spread<1>(work_.data(), [&](Index first, Index count, const auto& sums) {
      weights_.segment(static_cast<Index>(entry) * n + first, count) = sums[0].head(count).unaryExpr(&to_tangent);
    });
  }
  mixed_.each([&](Index first, Index last) {
    for (Index i = first; i < last; ++i) {
      Matrix near{};
      for (std::size_t entry = 0; entry < entries; ++entry) near[entry] = weights_[static_cast<Index>(entry) * n + i];
      near = weights(i, near);
      for (std::size_t entry = 0; entry < entries; ++entry)
        weights_[static_cast<Index>(entry) * n + i] = to_tangent(near[entry]);
    }
  });
}

template <typename IsFree>
void Extension::prepare_scalars(const IsFree& is_free) {
  find_mixed(is_free, true);
  prepare_with(
      [&](Index i) {
        const double part = is_free(i) ? 1.0 : 0.0;
        return Matrix{part, 0.0, part};
      },
      [&](Index i, const Matrix& near) {
        if (is_free(i)) return Matrix{};
        return Matrix{1.0 / (near[0] + kFade), 0.0, 1.0 / (near[2] + kFade)};
      });
}

void Extension::prepare(const Field& free) {
  prepare_scalars([&](Index i) { return free[i] != 0.0; });
}

void Extension::prepare(const TangentSpace& space, const Packing& packing) {
  if (space.components() == 1) return prepare_scalars([&](Index cell) { return packing.holds(cell, space.f1); });
  if (!knows_contact_) find_mixed([&](Index cell) { return packing.place(cell) >= 0; }, false);
  knows_contact_ = true;
  prepare_with(
      [&](Index cell) {
        const Index i = packing.place(cell);
        if (i < 0) return Matrix{};
        if (!space.on_line(i)) return Matrix{1.0, 0.0, 1.0};
        const double part = std::sqrt(static_cast<double>(space.scale[i]));
        return Matrix{part * space.f1[i] * space.f1[i], part * space.f1[i] * space.f2[i],
                      part * space.f2[i] * space.f2[i]};
      },
      [&](Index cell, const Matrix& near) {
        const Index i = packing.place(cell);
        if (i < 0) {
          const double determinant = (near[0] + kFade) * (near[2] + kFade) - near[1] * near[1];
          return Matrix{(near[2] + kFade) / determinant, -near[1] / determinant, (near[0] + kFade) / determinant};
        }
        if (!space.on_line(i)) return Matrix{};
        const double f1 = space.f1[i];
        const double f2 = space.f2[i];
        const double cross = 2.0 * f1 * f2 * near[1];
        const double across = 1.0 / (f2 * f2 * near[0] - cross + f1 * f1 * near[2] + kFade);
        const double along =
            (1.0 - static_cast<double>(space.scale[i])) / (f1 * f1 * near[0] + cross + f2 * f2 * near[2] + kFade);
        return Matrix{across * f2 * f2 + along * f1 * f1, (along - across) * f1 * f2,
                      across * f1 * f1 + along * f2 * f2};
      });
}

/// Multiplies the values of `count` cells by their weights.
template <std::size_t components>
void Extension::multiply(Index first, Index count, std::array<Line, components>& values) const {
  const auto weight = [&](Index entry) {
    return weights_.segment(entry * grid_.cells() + first, count).cast<double>();
  };
  auto first_one = values[0].head(count);
  if constexpr (components == 1) {
    first_one *= weight(0);
  } else {
    auto second = values[1].head(count);
    Line product;
    product.head(count) = weight(0) * first_one + weight(1) * second;
    second = weight(1) * first_one + weight(2) * second;
    first_one = product.head(count);
  }
}

template <std::size_t components>
void Extension::extend_all(Field& y) {
  spread<components>(y.data(), [&](Index first, Index count, auto& sums) {
    multiply(first, count, sums);
    for (std::size_t c = 0; c < components; ++c)
      work_.segment(static_cast<Index>(c) * grid_.cells() + first, count) = sums[c].head(count);
  });
  mixed_.each([&](Index first, Index last) {
    for (Index start = first; start < y.size(); start += grid_.cells())
      y.segment(start, last - first) += work_.segment(start, last - first);
  });
}

template <std::size_t components>
void Extension::collect_all(Field& y) {
  around_.each([&](Index first, Index last) {
    for (Index start = first; start < y.size(); start += grid_.cells()) work_.segment(start, last - first).setZero();
  });
  mixed_.each([&](Index first, Index last) {
    std::array<Line, components> values;
    for (Index start = first; start < last; start += kChunk) {
      const Index count = std::min(kChunk, last - start);
      const auto at = [&](std::size_t c) { return static_cast<Index>(c) * grid_.cells() + start; };
      for (std::size_t c = 0; c < components; ++c) values[c].head(count) = y.segment(at(c), count);
      multiply(start, count, values);
      for (std::size_t c = 0; c < components; ++c) work_.segment(at(c), count) = values[c].head(count);
    }
  });
  share_adjacent_rows(grid_, work_, kReach);
  spread<components>(work_.data(), [&](Index first, Index count, const auto& sums) {
    for (std::size_t c = 0; c < components; ++c)
      y.segment(static_cast<Index>(c) * grid_.cells() + first, count) += sums[c].head(count);
  });
}

void Extension::extend(Field& y) {
  share_adjacent_rows(grid_, y, kReach);
  y.size() == grid_.cells() ? extend_all<1>(y) : extend_all<2>(y);
}

void Extension::collect(Field& y) { y.size() == grid_.cells() ? collect_all<1>(y) : collect_all<2>(y); }

void Extension::redistribute(Packing& packing, const Field& free, Eigen::ArrayXd& p, Field& stays, Field& leaves) {
  const Sweep& cells = packing.cells();
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
  prepare_scalars([&](Index cell) { return packing.holds(cell, stays); });
  packing.on_grid(leaves, leaves, [&](const Field&, Field& field) { collect(field); });
  cells.each([&](Index first, Index last) {
    for (Index i = first; i < last; ++i) p[i] += static_cast<double>(stays[i] * leaves[i]);
  });
}

}  // namespace slipstick::solver
