#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <span>

#include "solver/grid/grid.hpp"

/// Which rows of a grid are this process's own, and fields that are known there.
namespace slipstick::solver {

/// The rows of a grid in at most kMax bands of equal numbers of rows. Sums are taken band by band and then
/// in the order of the bands, and ranks share the bands: so no sum depends on how many ranks there are.
class RowBands {
 public:
  static constexpr Index kMax = 64;
  /// Transforms take rows in groups, which lie in one band.
  static constexpr Index kRows = 16;

  /// min_rows: rows of a band, at least.
  explicit RowBands(Index rows, const Ranks& ranks = {}, Index min_rows = kRows)
      : ranks_(ranks),
        rows_(rows),
        of_band_(min_rows * std::max<Index>((rows + min_rows * kMax - 1) / (min_rows * kMax), 1)) {}

  Index count() const { return (rows_ + of_band_ - 1) / of_band_; }
  Share rows(Index band) const { return {band * of_band_, std::min((band + 1) * of_band_, rows_)}; }
  /// Bands of this rank, and their rows.
  Share own() const { return ranks_.own_share(count()); }
  Share own_rows() const {
    const Share bands = own();
    return {std::min(bands.first * of_band_, rows_), std::min(bands.last * of_band_, rows_)};
  }
  /// Rows that each rank has but the last ones.
  Index rows_of_rank() const { return ranks_.block_of(count()) * of_band_; }

 private:
  Ranks ranks_;
  Index rows_;
  Index of_band_;
};

/// The rows of a grid that are this process's own: all of them where no other process shares the grid.
inline Share own_rows(const Grid& grid) { return RowBands(grid.n1, grid.ranks).own_rows(); }

/// Makes a field of any number of components whole: each process gets the rows of the others.
inline void share_rows(const Grid& grid, std::span<double> field) {
  const auto cells = static_cast<std::size_t>(grid.cells());
  if (!grid.ranks.several() || cells == 0) return;
  const Index rows = RowBands(grid.n1, grid.ranks).rows_of_rank();
  for (std::size_t start = 0; start < field.size(); start += cells) {
    grid.ranks.gather(field.subspan(start, cells), grid.n1, rows);
  }
}
inline void share_rows(const Grid& grid, Eigen::ArrayXd& field) {
  share_rows(grid, std::span(field.data(), static_cast<std::size_t>(field.size())));
}

/// Brings the rows next to this process's own, so many on each side, into a field of any number of
/// components.
inline void share_rows_beside(const Grid& grid, Eigen::ArrayXd& field, Index depth) {
  for (Index start = 0; start < field.size(); start += grid.cells()) {
    grid.ranks.gather_beside(std::span(field.data() + start, static_cast<std::size_t>(grid.cells())), grid.n1,
                             RowBands(grid.n1, grid.ranks).rows_of_rank(), depth);
  }
}

/// work(first, count) for the cells of this process's own rows, in each component of a field.
template <typename Work>
void in_own_rows(const Grid& grid, Index size, const Work& work) {
  const Share rows = own_rows(grid);
  for (Index start = 0; start < size; start += grid.cells()) {
    work(start + rows.first * grid.n2, rows.count() * grid.n2);
  }
}

/// A field that is known in this process's own rows alone: the memory of the other rows is given back.
inline Eigen::ArrayXd in_own_rows(const Grid& grid, Eigen::ArrayXd field) {
  if (!grid.ranks.several()) return field;
  Eigen::ArrayXd own(field.size());
  in_own_rows(grid, field.size(),
              [&](Index first, Index count) { own.segment(first, count) = field.segment(first, count); });
  return own;
}

}  // namespace slipstick::solver
