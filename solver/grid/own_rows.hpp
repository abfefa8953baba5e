#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <span>

#include "solver/grid/grid.hpp"

/// The rows of a grid that belong to this rank, and fields that are known only there.
namespace slipstick::solver {

/// Rows lie in at most kMaxBands bands of equally many rows (the last may have fewer). Each rank owns whole
/// bands, and sums are taken band by band, so that no sum depends on the number of ranks.
inline constexpr Index kMaxBands = 64;
/// Rows of the shortest band: a multiple of the groups of rows that transforms carry together.
inline constexpr Index kRowsOfBand = 16;

inline Index rows_of_band(Index rows, Index least = kRowsOfBand) {
  return least * std::max<Index>((rows + least * kMaxBands - 1) / (least * kMaxBands), 1);
}

/// Rows of each rank; the last ranks have fewer.
inline Index rows_of_rank(Index rows, const Ranks& ranks) {
  const Index of_band = rows_of_band(rows);
  return ranks.block_of((rows + of_band - 1) / of_band) * of_band;
}

inline IndexRange own_rows(Index rows, const Ranks& ranks) {
  const Index block = rows_of_rank(rows, ranks);
  return {std::min(ranks.rank() * block, rows), std::min((ranks.rank() + 1) * block, rows)};
}
inline IndexRange own_rows(const Grid& grid) { return own_rows(grid.n1, grid.ranks); }

/// Makes a field of any number of components whole on every rank.
inline void share_rows(const Grid& grid, std::span<double> field) {
  const auto cells = static_cast<std::size_t>(grid.cells());
  if (!grid.ranks.several() || cells == 0) return;
  const Index block = rows_of_rank(grid.n1, grid.ranks);
  for (std::size_t start = 0; start < field.size(); start += cells) {
    grid.ranks.gather(field.subspan(start, cells), grid.n1, block);
  }
}
inline void share_rows(const Grid& grid, Eigen::ArrayXd& field) {
  share_rows(grid, std::span(field.data(), static_cast<std::size_t>(field.size())));
}

/// Brings `depth` rows on each side of this rank's own into a field of any number of components.
inline void share_adjacent_rows(const Grid& grid, auto& field, Index depth) {
  for (Index start = 0; start < field.size(); start += grid.cells()) {
    grid.ranks.gather_adjacent(std::span(field.data() + start, static_cast<std::size_t>(grid.cells())), grid.n1,
                               rows_of_rank(grid.n1, grid.ranks), depth);
  }
}

/// work(first, count) for the cells of this rank's rows, in each component of a field.
template <typename Work>
void in_own_rows(const Grid& grid, Index size, const Work& work) {
  const IndexRange rows = own_rows(grid);
  for (Index start = 0; start < size; start += grid.cells()) {
    work(start + rows.first * grid.n2, rows.count() * grid.n2);
  }
}

/// The same field in memory that holds only this rank's rows.
inline Eigen::ArrayXd in_own_rows(const Grid& grid, Eigen::ArrayXd field) {
  if (!grid.ranks.several()) return field;
  Eigen::ArrayXd own(field.size());
  in_own_rows(grid, field.size(),
              [&](Index first, Index count) { own.segment(first, count) = field.segment(first, count); });
  return own;
}

}  // namespace slipstick::solver
