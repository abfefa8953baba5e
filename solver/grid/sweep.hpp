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

/// A set of a field's cells, kept as intervals of neighbours, which loops and sums visit. Sums are taken band
/// by band (own_rows.hpp) and then in the order of the bands, so that no result depends on the number of
/// threads or ranks that share the bands.
class Sweep {
 public:
  /// The empty set: of no cells, of the cells of a grid, or of cells that have no rows and one process.
  Sweep() = default;
  explicit Sweep(const Grid& grid) : size_(grid.cells()), row_(grid.n2), ranks_(grid.ranks) {
    set_bands(rows_of_band(grid.n1) * std::max<Index>(grid.n2, 1));
  }
  explicit Sweep(Index cells) : size_(cells), row_(cells) { set_bands(rows_of_band(cells, kCellsOfBand)); }

  /// The cells where a field, of one value a cell, is not zero.
  template <typename Field>
  Sweep(const Grid& grid, const Field& field) : Sweep(grid) {
    assign([&](Index cell) { return field.coeff(cell) != 0; });
  }
  template <typename Derived>
  explicit Sweep(const Eigen::ArrayBase<Derived>& field) : Sweep(field.size()) {
    assign([&](Index cell) { return field.coeff(cell) != 0; });
  }

  /// All cells.
  template <typename Cells>
  static Sweep whole(const Cells& cells) {
    Sweep sweep(cells);
    sweep.assign([](Index) { return true; });
    return sweep;
  }

  /// The cells for which contains(cell) is true.
  template <typename Contains>
  void assign(const Contains& contains);

  /// Cells of the field, and cells in the set, on all ranks together.
  Index size() const { return size_; }
  Index count() const { return count_; }

  /// True for many small spots or a ragged edge: there are more intervals than kIntervalsOfSmooth times
  /// sqrt(count()). A disc has 1.13 sqrt(count()), a few discs or rings somewhat more.
  bool is_ragged() const { return is_ragged_; }

  /// All cells of a field that stores the cells of this set only, one after the other, in the same bands.
  Sweep packed() const;

  /// work(first, last) for each interval [first, last) of cells, on several threads; it must not throw.
  template <typename Work>
  void each(const Work& work) const {
    each_with_place([&](Index first, Index last, Index) { work(first, last); });
  }
  /// The same with work(first, last, place): `place` cells of the set come before `first`.
  template <typename Work>
  void each_with_place(const Work& work) const {
    const Index parts = threads(visited());
    in_parts(static_cast<int>(parts), parts, [&](int, Index first_part, Index last_part) {
      const std::size_t begin = cut(first_part, parts);
      Index place = place_ + bands_[begin].visited;
      for (Index i = bands_[begin].interval; i < bands_[cut(last_part, parts)].interval; ++i) {
        const auto [first, last] = intervals_[at(i)];
        work(first, last, place);
        place += last - first;
      }
    });
  }

  /// work(first, last) for all cells of this rank's rows, in as many parts as there are threads.
  template <typename Work>
  void each_own(const Work& work) const {
    const Index first_own = bands_[at(own_bands_.first)].cell;
    const Index count = bands_[at(own_bands_.last)].cell - first_own;
    in_parts(threads(count), count, [&](int, Index first, Index last) {
      if (first < last) work(first_own + first, first_own + last);
    });
  }

  /// The sum of all that work(first, last, sum) adds to `sum`, which starts as Sum().
  template <typename Sum, typename Work>
  Sum sum(const Work& work) const {
    const auto sum_of = [&](std::size_t band) {
      Sum sum{};
      for (Index i = bands_[band].interval; i < bands_[band + 1].interval; ++i) {
        work(intervals_[at(i)].first, intervals_[at(i)].last, sum);
      }
      return sum;
    };
    if (band_count_ == 1 && !ranks_.several()) return sum_of(0);
    std::array<Sum, kMaxBands> sums;
    const Index parts = threads(visited());
    in_parts(static_cast<int>(parts), parts, [&](int, Index first, Index last) {
      const std::size_t end = cut(last, parts);
      for (std::size_t band = cut(first, parts); band < end; ++band) sums[band] = sum_of(band);
    });
    if (ranks_.several()) ranks_.gather_shares(std::span(sums).first(at(band_count_)));
    Sum total = sums.front();
    for (Index band = 1; band < band_count_; ++band) total += sums[at(band)];
    return total;
  }

 private:
  /// Where a band starts: its first cell, its first interval, and the cells visited by this rank before it.
  struct Band {
    Index cell = 0;
    Index interval = 0;
    Index visited = 0;
  };
  /// Cells of the shortest band of a field without rows.
  static constexpr Index kCellsOfBand = 512;
  /// With fewer cells a second thread is not worth its start.
  static constexpr Index kCellsOfOneThread = 8 * kCellsOfBand;

  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
  static int threads(Index cells) { return cells < kCellsOfOneThread ? 1 : ThreadPool::available(); }
  Index visited() const { return bands_.back().visited; }
  void set_bands(Index cells_of_band);
  /// The first band of a part of the bands; for part == parts, the end. All parts visit about as many cells.
  std::size_t cut(Index part, Index parts) const {
    if (part == 0) return at(own_bands_.first);
    if (part == parts) return at(own_bands_.last);
    const auto first = bands_.begin() + own_bands_.first;
    const auto last = bands_.begin() + own_bands_.last;
    return at(std::ranges::lower_bound(first, last, visited() * part / parts, {}, &Band::visited) - bands_.begin());
  }

  Index size_ = 0;
  Index row_ = 0;  ///< intervals end at the multiples of this length in a band
  Ranks ranks_;    ///< that share the bands
  Index band_count_ = 1;
  IndexRange own_bands_{0, 1};
  std::array<Band, kMaxBands + 1> bands_{};
  std::vector<IndexRange> intervals_;
  Index count_ = 0;
  Index place_ = 0;  ///< cells of the set that lower ranks visit
  bool is_ragged_ = false;
};

/// Zeroes a field of any number of components in this rank's rows.
template <typename Field>
void clear(const Sweep& cells, Field& field) {
  cells.each_own([&](Index first, Index last) {
    for (Index start = 0; start < field.size(); start += cells.size()) {
      field.segment(start + first, last - first).setZero();
    }
  });
}

template <typename Contains>
void Sweep::assign(const Contains& contains) {
  intervals_.clear();
  Index visited = 0;
  for (Index band = 0; band <= kMaxBands; ++band) {
    bands_[at(band)].interval = static_cast<Index>(intervals_.size());
    bands_[at(band)].visited = visited;
    if (band < own_bands_.first || band >= own_bands_.last) continue;
    bool inside = false;
    Index row_end = bands_[at(band)].cell + row_;
    for (Index cell = bands_[at(band)].cell; cell < bands_[at(band) + 1].cell; ++cell) {
      if (cell == row_end) {  // sums over longer intervals would round more
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
      ++visited;
    }
  }
  count_ = visited;
  place_ = 0;
  auto intervals = static_cast<double>(intervals_.size());
  if (ranks_.several()) {
    const std::vector<double> of_each = ranks_.of_each(static_cast<double>(visited));
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

inline void Sweep::set_bands(Index cells_of_band) {
  band_count_ = std::max<Index>((size_ + cells_of_band - 1) / cells_of_band, 1);
  own_bands_ = ranks_.own_share(band_count_);
  for (Index band = 0; band <= band_count_; ++band) bands_[at(band)].cell = std::min(band * cells_of_band, size_);
}

inline Sweep Sweep::packed() const {
  Sweep packed(*this);
  packed.size_ = count_;
  packed.row_ = kCellsOfBand;
  for (Band& band : packed.bands_) band.cell = place_ + band.visited;
  packed.assign([](Index) { return true; });
  packed.is_ragged_ = is_ragged_;
  return packed;
}

}  // namespace slipstick::solver
