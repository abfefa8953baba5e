#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "solver/grid/communicator.hpp"

namespace slipstick::solver {

/// Of what ranks share out, what one of them has: [first, last).
struct Share {
  Index first;
  Index last;
  Index count() const { return last - first; }
  bool operator==(const Share&) const = default;
};

/// The processes of one run that solve one contact together: ranks of MPI, started by mpirun. A program that
/// was not is the only rank, number 0.
///
/// Every rank knows a field by the same addresses, of all its cells. Where ranks share the work each holds
/// what its own rows have, and the memory of the others' rows is not touched, so that the system never gives
/// it; gather() makes a field whole.
class Ranks {
 public:
  /// Joins those that mpirun has started, if it has, as long as this object lives. It is made once, and on
  /// the thread that calls what is below. Throws std::runtime_error where the library for it is not there.
  Ranks();
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  static int number();
  static int rank();
  /// Whether this is the rank that prints and writes files.
  static bool first() { return rank() == 0; }

  /// What one rank of so many has of a count, in equal blocks, the last ones smaller or empty.
  static Share share(Index count, int rank, int number) {
    const Index block = block_of(count, number);
    return {std::min(rank * block, count), std::min((rank + 1) * block, count)};
  }
  static Share own_share(Index count) { return share(count, rank(), number()); }
  static Index block_of(Index count, int number) { return (count + number - 1) / number; }

  /// Makes a field of some rows whole on every rank, each of which has so many rows, the last ones fewer.
  static void gather(std::span<double> field, Index rows, Index rows_of_rank) {
    if (number() > 1)
      communicator().gather(field.data(), field.size_bytes() / size(rows), rows, rows_of_rank);
  }
  /// Brings the rows next to this rank's from the ranks that have them, so many on each side.
  static void gather_beside(std::span<double> field, Index rows, Index rows_of_rank, Index depth) {
    if (number() == 1 || rows == 0) return;
    communicator().gather_beside(field.data(), field.size_bytes() / size(rows), rows, rows_of_rank, depth);
  }
  /// Makes a row of things whole of which each rank has its share().
  template <typename Thing>
  static void gather_shares(std::span<Thing> things) {
    if (number() == 1) return;
    const auto count = static_cast<Index>(things.size());
    communicator().gather(things.data(), sizeof(Thing), count, block_of(count, number()));
  }
  /// One number of each rank, on all of them.
  static std::vector<double> of_each(double own);
  /// A text of the first rank, of less than 8 KiB, on all of them.
  static std::string of_first(const std::string& own);

  /// Several ranks alone have one.
  static Communicator& communicator();
  /// What this rank has sent to others.
  static Communicator::Sent sent();

  /// Waits for the other ranks. A rank that failed waits for some seconds: where the others go on without it,
  /// it says why and ends them all with its exit code.
  static void end(int exit_code, const std::string& failure = {});

 private:
  static std::size_t size(Index rows) { return static_cast<std::size_t>(rows); }
};

/// As long as it lives, sizes are those of the first of so many ranks, of which there is none but this one:
/// for predictions.
class PlannedRanks {
 public:
  explicit PlannedRanks(int number);
  ~PlannedRanks();
  PlannedRanks(const PlannedRanks&) = delete;
  PlannedRanks& operator=(const PlannedRanks&) = delete;

 private:
  std::unique_ptr<Communicator> outer_;
};

/// The rows of a grid in at most kMost bands of equal numbers of them. Sums are taken band by band and then
/// in their order, and ranks share the bands: so no sum depends on how many ranks there are.
class RowBands {
 public:
  static constexpr Index kMost = 64;
  /// Transforms take rows in groups, which lie in one band.
  static constexpr Index kRows = 16;

  explicit RowBands(Index rows, Index least = kRows)
      : rows_(rows), of_band_(least * std::max<Index>((rows + least * kMost - 1) / (least * kMost), 1)) {}

  Index count() const { return (rows_ + of_band_ - 1) / of_band_; }
  Share rows(Index band) const { return {band * of_band_, std::min((band + 1) * of_band_, rows_)}; }
  /// Of this rank.
  Share own() const { return Ranks::own_share(count()); }
  Share own_rows() const {
    return {std::min(own().first * of_band_, rows_), std::min(own().last * of_band_, rows_)};
  }
  /// That each rank has but the last ones.
  Index rows_of_rank() const { return Ranks::block_of(count(), Ranks::number()) * of_band_; }

 private:
  Index rows_;
  Index of_band_;
};

/// Makes a field of any number of components whole on every rank.
inline void gather(const Grid& grid, std::span<double> field) {
  if (Ranks::number() == 1) return;
  const auto cells = static_cast<std::size_t>(grid.cells());
  if (cells == 0) return;
  const Index rows = RowBands(grid.n1).rows_of_rank();
  for (std::size_t start = 0; start < field.size(); start += cells) {
    Ranks::gather(field.subspan(start, cells), grid.n1, rows);
  }
}

/// work(first, count) for this rank's cells of each component of a field.
template <typename Work>
void in_own_rows(const Grid& grid, Index size, const Work& work) {
  const Share rows = RowBands(grid.n1).own_rows();
  for (Index start = 0; start < size; start += grid.cells()) {
    work(start + rows.first * grid.n2, rows.count() * grid.n2);
  }
}

/// A field that is known in this rank's rows alone: the memory of the others' rows is given back.
inline Eigen::ArrayXd own_rows(const Grid& grid, Eigen::ArrayXd field) {
  if (Ranks::number() == 1) return field;
  Eigen::ArrayXd own(field.size());
  in_own_rows(grid, field.size(),
              [&](Index first, Index count) { own.segment(first, count) = field.segment(first, count); });
  return own;
}

}  // namespace slipstick::solver
