#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "solver/grid/own_rows.hpp"
#include "solver/grid/threads.hpp"

namespace slipstick::solver {

/// Adds several sums of one sweep at once.
template <std::size_t N>
std::array<double, N>& operator+=(std::array<double, N>& sums, const std::array<double, N>& more) {
  for (std::size_t k = 0; k < N; ++k) sums[k] += more[k];
  return sums;
}

/// Those cells that a loop visits, as intervals of neighbours: cells that carry no traction cost nothing.
/// Sums are taken in bands of rows, see RowBands, and then in the order of the bands, whatever threads of the
/// pool and processes of the grid share the bands: so no result depends on the number of either.
class Sweep {
 public:
  /// No cell yet, and rows that nobody shares.
  Sweep() = default;
  /// No cell of a grid yet: intervals end with its rows, which its processes share.
  explicit Sweep(const Grid& grid) : row_(grid.n2), ranks_(grid.ranks) {}
  /// Cells where a field, one value a cell, is not zero.
  template <typename Field>
  Sweep(const Grid& grid, const Field& field) : Sweep(grid) {
    assign_nonzero(field);
  }
  /// Likewise for cells without rows: every process visits them all.
  template <typename Derived>
  explicit Sweep(const Eigen::ArrayBase<Derived>& field) {
    assign_nonzero(field);
  }

  /// Over all cells, whatever they carry.
  static Sweep whole(const Grid& grid) {
    Sweep sweep(grid);
    sweep.assign(grid.cells(), [](Index) { return true; });
    return sweep;
  }
  static Sweep whole(Index cells) {
    Sweep sweep;
    sweep.assign(cells, [](Index) { return true; });
    return sweep;
  }

  /// The cells below `cells` for which contains(cell) is true.
  template <typename Contains>
  void assign(Index cells, const Contains& contains);

  /// Cells of the grid, and those that are visited, by all processes together.
  Index size() const { return size_; }
  Index count() const { return count_; }

  /// Whether they lie in many small spots or have a ragged edge: intervals are many more than in a disc of as
  /// many cells, which has 1.13 times the root of their number, or in a few such discs and rings.
  bool is_ragged() const {
    constexpr double kIntervalsOfSmooth = 4.0;
    const double intervals = sum<double>([](Index, Index, double& sum) { sum += 1.0; });
    return intervals > kIntervalsOfSmooth * std::sqrt(static_cast<double>(count_));
  }

  /// work(first, last) for each interval [first, last) of cells; several threads at the same time. It must
  /// not throw.
  template <typename Work>
  void each(const Work& work) const {
    const Index parts = threads();
    in_parts(threads(), parts, [&](int, Index first, Index last) {
      for (Index i = begin_[cut(first, parts)]; i < begin_[cut(last, parts)]; ++i) {
        work(intervals_[at(i)].first, intervals_[at(i)].last);
      }
    });
  }

  /// work(first, last) for all cells of this process's rows, in as many parts as there are threads.
  template <typename Work>
  void each_own(const Work& work) const {
    in_parts(threads(), own_.count(), [&](int, Index first, Index last) {
      if (first < last) work(own_.first + first, own_.first + last);
    });
  }

  /// The sum of what work(first, last, sum) adds to `sum`, which begins as Sum().
  template <typename Sum, typename Work>
  Sum sum(const Work& work) const {
    const auto sum_of = [&](Index band) {
      Sum sum{};
      for (Index i = begin_[at(band)]; i < begin_[at(band + 1)]; ++i) {
        work(intervals_[at(i)].first, intervals_[at(i)].last, sum);
      }
      return sum;
    };
    if (bands_ == 1 && !shared()) return sum_of(0);
    std::array<Sum, RowBands::kMax> sums;
    const Index parts = threads();
    in_parts(threads(), parts, [&](int, Index first, Index last) {
      const std::size_t end = cut(last, parts);
      for (std::size_t band = cut(first, parts); band < end; ++band) {
        sums[band] = sum_of(static_cast<Index>(band));
      }
    });
    if (shared()) ranks_.gather_shares(std::span(sums).first(at(bands_)));
    Sum total = sums.front();
    for (Index band = 1; band < bands_; ++band) total += sums[at(band)];
    return total;
  }

 private:
  struct Interval {
    Index first;
    Index last;
  };
  /// Cells of a band, at least, where there are no rows.
  static constexpr Index kCellsOfBand = 512;
  /// With fewer cells a second thread is not worth its start.
  static constexpr Index kCellsOfOneThread = 8 * kCellsOfBand;

  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
  template <typename Field>
  void assign_nonzero(const Field& field) {
    assign(field.size(), [&](Index cell) { return field.coeff(cell) != 0; });
  }
  bool shared() const { return row_ > 0 && ranks_.several(); }
  RowBands bands() const {
    return row_ > 0 ? RowBands(size_ / row_, ranks_) : RowBands(size_, {}, kCellsOfBand);
  }
  int threads() const { return visited_ < kCellsOfOneThread ? 1 : ThreadPool::available(); }
  /// The first band of a part, or past the last one: as many cells of a band are visited as its rows have of
  /// them, and each part gets about as many.
  std::size_t cut(Index part, Index parts) const {
    const auto first = before_.begin() + own_bands_.first;
    const auto last = before_.begin() + own_bands_.last;
    if (part == 0) return at(own_bands_.first);
    if (part == parts) return at(own_bands_.last);
    return at(std::lower_bound(first, last, visited_ * part / parts) - before_.begin());
  }

  std::vector<Interval> intervals_;
  std::array<Index, RowBands::kMax + 1> begin_{};   ///< the first interval of each band
  std::array<Index, RowBands::kMax + 1> before_{};  ///< cells of this process visited before each
  Index row_ = 0;                                   ///< cells of a row; 0: there are no rows
  Ranks ranks_;
  Index size_ = 0;
  Index count_ = 0;
  Index visited_ = 0;  ///< by this process
  Index bands_ = 1;
  Share own_{0, 0};
  Share own_bands_{0, 1};
};

/// A field of any number of components: zero in this process's rows.
template <typename Field>
void clear(const Sweep& cells, Field& field) {
  cells.each_own([&](Index first, Index last) {
    for (Index start = 0; start < field.size(); start += cells.size()) {
      field.segment(start + first, last - first).setZero();
    }
  });
}

template <typename Contains>
void Sweep::assign(Index cells, const Contains& contains) {
  size_ = cells;
  const RowBands bands = this->bands();
  const Index of_row = std::max<Index>(row_, 1);
  bands_ = std::max<Index>(bands.count(), 1);
  own_bands_ = shared() ? bands.own() : Share{0, bands_};
  intervals_.clear();
  visited_ = 0;
  begin_.fill(0);
  before_.fill(0);
  own_ = {shared() ? bands.own_rows().first * of_row : 0, shared() ? bands.own_rows().last * of_row : cells};
  for (Index band = own_bands_.first; band < own_bands_.last; ++band) {
    const Share rows = bands.rows(band);
    begin_[at(band)] = static_cast<Index>(intervals_.size());
    before_[at(band)] = visited_;
    bool inside = false;
    Index row_end = rows.first * of_row + row_;
    for (Index cell = rows.first * of_row; cell < rows.last * of_row; ++cell) {
      if (cell == row_end) {
        inside = false;
        row_end += row_;
      }
      if (!contains(cell)) {
        inside = false;
        continue;
      }
      if (!inside) intervals_.push_back({cell, cell});
      inside = true;
      intervals_.back().last = cell + 1;
      ++visited_;
    }
  }
  for (Index band = own_bands_.last; band <= RowBands::kMax; ++band) {
    begin_[at(band)] = static_cast<Index>(intervals_.size());
    before_[at(band)] = visited_;
  }
  count_ = visited_;
  if (!shared()) return;
  count_ = 0;
  for (const double visited : ranks_.of_each(static_cast<double>(visited_)))
    count_ += static_cast<Index>(visited);
}

}  // namespace slipstick::solver
