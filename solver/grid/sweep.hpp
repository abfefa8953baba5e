#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "solver/grid/threads.hpp"

namespace slipstick::solver {

/// Those cells of a grid that a loop visits, as intervals of neighbours: cells that carry no traction cost
/// nothing. The cells are cut into parts, by their number alone and about equal in size, which the threads of
/// the pool share; sums are taken part by part and then in their order. So no result depends on the number of
/// threads.
class Sweep {
 public:
  /// None yet.
  Sweep() = default;
  /// Cells where a field, one value a cell, is not zero.
  template <typename Field>
  explicit Sweep(const Field& field) {
    assign(field.size(), [&](Index cell) { return field[cell] != 0; });
  }

  /// The cells below `cells` for which contains(cell) is true.
  template <typename Contains>
  void assign(Index cells, const Contains& contains);

  /// Cells of the grid, and those that are visited.
  Index size() const { return size_; }
  Index count() const { return count_; }
  std::size_t bytes() const { return intervals_.capacity() * sizeof(Interval); }

  /// work(first, last) for each interval [first, last) of cells; several threads at the same time. It must
  /// not throw.
  template <typename Work>
  void each(const Work& work) const {
    in_parts(threads(), parts_, [&](int, Index first, Index last) {
      for (Index i = begin_[at(first)]; i < begin_[at(last)]; ++i) {
        work(intervals_[at(i)].first, intervals_[at(i)].last);
      }
    });
  }

  /// The sum of what work(first, last, sum) adds to `sum`, which begins as Sum().
  template <typename Sum, typename Work>
  Sum sum(const Work& work) const {
    const auto sum_of = [&](Index part) {
      Sum sum{};
      for (Index i = begin_[at(part)]; i < begin_[at(part + 1)]; ++i) {
        work(intervals_[at(i)].first, intervals_[at(i)].last, sum);
      }
      return sum;
    };
    if (parts_ == 1) return sum_of(0);
    std::array<Sum, kMostParts> sums;
    in_parts(threads(), parts_, [&](int, Index first, Index last) {
      for (Index part = first; part < last; ++part) sums[at(part)] = sum_of(part);
    });
    Sum total = sums.front();
    for (Index part = 1; part < parts_; ++part) total += sums[at(part)];
    return total;
  }

 private:
  struct Interval {
    Index first;
    Index last;
  };
  static constexpr Index kMostParts = 64;
  /// Of a part, at least; where there are fewer than some such parts a second thread is not worth it.
  static constexpr Index kCellsOfPart = 512;
  static constexpr Index kFew = 8 * kCellsOfPart;

  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
  int threads() const { return count_ < kFew ? 1 : ThreadPool::available(); }

  std::vector<Interval> intervals_;
  std::array<Index, kMostParts + 1> begin_{};  ///< the first interval of each part
  Index size_ = 0;
  Index count_ = 0;
  Index parts_ = 1;
};

template <typename Contains>
void Sweep::assign(Index cells, const Contains& contains) {
  size_ = cells;
  count_ = 0;
  for (Index cell = 0; cell < cells; ++cell) count_ += contains(cell) ? 1 : 0;
  parts_ = std::clamp<Index>(count_ / kCellsOfPart, 1, kMostParts);
  intervals_.clear();
  Index visited = 0;
  Index part = 0;
  bool inside = false;
  for (Index cell = 0; cell < cells; ++cell) {
    if (!contains(cell)) {
      inside = false;
      continue;
    }
    // A part that is full ends here, and with it an interval.
    while (part < parts_ && visited * parts_ >= part * count_) {
      begin_[at(part++)] = static_cast<Index>(intervals_.size());
      inside = false;
    }
    if (!inside) intervals_.push_back({cell, cell});
    inside = true;
    intervals_.back().last = cell + 1;
    ++visited;
  }
  for (; part <= parts_; ++part) begin_[at(part)] = static_cast<Index>(intervals_.size());
}

}  // namespace slipstick::solver
