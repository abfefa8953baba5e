#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
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

/// The least of values, as a sum.
struct Lowest {
  double value = std::numeric_limits<double>::infinity();
  Lowest& operator+=(const Lowest& other) {
    if (!(other.value >= value)) value = other.value;
    return *this;
  }
};

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
  bool is_ragged() const { return is_ragged_; }

  /// All of the cells of fields that hold these cells alone, one behind the other: in the same bands, which
  /// have no rows.
  Sweep packed() const;

  /// work(first, last) for each interval [first, last) of cells; several threads at the same time. It must
  /// not throw.
  template <typename Work>
  void each(const Work& work) const {
    each_with_place([&](Index first, Index last, Index) { work(first, last); });
  }
  /// work(first, last, place) likewise, with the place of its first cell among all that are visited.
  template <typename Work>
  void each_with_place(const Work& work) const {
    const Index parts = threads();
    in_parts(threads(), parts, [&](int, Index first_part, Index last_part) {
      const std::size_t begin = cut(first_part, parts);
      Index place = place_ + before_[begin];
      for (Index i = begin_[begin]; i < begin_[cut(last_part, parts)]; ++i) {
        const auto [first, last] = intervals_[at(i)];
        work(first, last, place);
        place += last - first;
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
  void set_bands(Index cells);
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
  std::array<Index, RowBands::kMax + 1> limits_{};  ///< the first cell of each band
  std::array<Index, RowBands::kMax + 1> begin_{};   ///< the first interval of each band
  std::array<Index, RowBands::kMax + 1> before_{};  ///< cells of this process visited before each
  Index row_ = 0;                                   ///< cells of a row; 0: there are no rows
  Ranks ranks_;
  Index size_ = 0;
  Index count_ = 0;
  Index visited_ = 0;  ///< by this process
  Index place_ = 0;    ///< of the first of these among those of all processes
  bool is_ragged_ = false;
  bool packed_ = false;  ///< cells of fields without rows, in the bands of others
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
  if (!packed_) set_bands(cells);
  // Sums over long intervals would round by more.
  const Index row = packed_ ? kCellsOfBand : row_ > 0 ? row_ : cells;
  intervals_.clear();
  visited_ = 0;
  begin_.fill(0);
  before_.fill(0);
  for (Index band = own_bands_.first; band < own_bands_.last; ++band) {
    begin_[at(band)] = static_cast<Index>(intervals_.size());
    before_[at(band)] = visited_;
    bool inside = false;
    const Index first = limits_[at(band)];
    const Index end = limits_[at(band + 1)];
    Index row_end = first + row;
    for (Index cell = first; cell < end; ++cell) {
      if (cell == row_end) {
        inside = false;
        row_end += row;
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
  place_ = 0;
  auto intervals = static_cast<double>(intervals_.size());
  if (shared()) {
    const std::vector<double> of_each = ranks_.of_each(static_cast<double>(visited_));
    const auto sum_to = [&](int rank) {
      return static_cast<Index>(std::accumulate(of_each.begin(), of_each.begin() + rank, 0.0));
    };
    count_ = sum_to(ranks_.number());
    place_ = sum_to(ranks_.rank());
    const std::vector<double> intervals_of_each = ranks_.of_each(intervals);
    intervals = std::accumulate(intervals_of_each.begin(), intervals_of_each.end(), 0.0);
  }
  constexpr double kIntervalsOfSmooth = 4.0;
  is_ragged_ = intervals > kIntervalsOfSmooth * std::sqrt(static_cast<double>(count_));
}

inline void Sweep::set_bands(Index cells) {
  size_ = cells;
  const RowBands bands = row_ > 0 ? RowBands(size_ / row_, ranks_) : RowBands(size_, {}, kCellsOfBand);
  const Index of_row = std::max<Index>(row_, 1);
  bands_ = std::max<Index>(bands.count(), 1);
  own_bands_ = shared() ? bands.own() : Share{0, bands_};
  for (Index band = 0; band <= bands_; ++band)
    limits_[at(band)] = std::min(bands.rows(band).first * of_row, cells);
  own_ = {limits_[at(own_bands_.first)], limits_[at(own_bands_.last)]};
}

inline Sweep Sweep::packed() const {
  Sweep packed(*this);
  packed.packed_ = true;
  packed.size_ = count_;
  packed.own_ = {place_, place_ + visited_};
  for (std::size_t band = 0; band < limits_.size(); ++band) packed.limits_[band] = place_ + before_[band];
  packed.assign(count_, [](Index) { return true; });
  packed.is_ragged_ = is_ragged_;
  return packed;
}

}  // namespace slipstick::solver
