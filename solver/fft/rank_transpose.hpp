#pragma once

#include <algorithm>
#include <cstddef>

#include "solver/grid/own_rows.hpp"
#include "solver/mpi/communicator.hpp"

namespace slipstick::solver {

/// The exchange between ranks between a transform's pass over rows and its pass over columns; on one rank it
/// does nothing. An entry of the matrix is `entry` numbers.
struct RankTranspose {
  Ranks ranks;
  Index rows;
  Index rows_of_rank;
  Index columns;
  Index entry;
  Index pad = 0;  ///< entries that no rank has at the end of a row

  IndexRange own_columns() const { return ranks.own_share(columns); }
  Index columns_of_rank() const { return ranks.block_of(columns); }
  /// Numbers from one row of this rank to the next, and in all of them.
  Index row_step() const { return (ranks.number() * columns_of_rank() + pad) * entry; }
  Index size() const { return std::min(rows_of_rank, rows) * row_step(); }

  /// work(i, values) for the entries of all rows in one of this rank's columns, once they are carried.
  template <typename Work>
  void each_row(double* buffer, Index own_column, const Work& work) const {
    const Index step = row_step();
    for (Index first = 0; first < rows; first += rows_of_rank) {
      double* const part = buffer + (first / rows_of_rank * columns_of_rank() + own_column) * entry;
      const Index last = std::min(first + rows_of_rank, rows);
      for (Index i = first; i < last; ++i) work(i, part + (i - first) * step);
    }
  }

  void to_columns(double* buffer) const { transpose(buffer, true); }
  void to_rows(double* buffer) const { transpose(buffer, false); }

  /// Bytes that all ranks together send in one direction.
  double sent_bytes() const {
    double entries = 0.0;
    for (int rank = 0; rank < ranks.number(); ++rank) {
      const Index first = std::min(rank * rows_of_rank, rows);
      const Index own = std::min(first + rows_of_rank, rows) - first;
      const Index others = columns - Ranks::share(columns, rank, ranks.number()).count();
      entries += static_cast<double>(own) * static_cast<double>(others);
    }
    return entries * static_cast<double>(entry) * sizeof(double);
  }

 private:
  void transpose(double* buffer, bool to_columns) const {
    if (!ranks.several()) return;
    const auto bytes = [](Index numbers) { return static_cast<std::size_t>(numbers) * sizeof(double); };
    ranks.communicator().transpose(
        buffer, {rows, rows_of_rank, columns, columns_of_rank(), bytes(entry), bytes(row_step())}, to_columns);
  }
};

}  // namespace slipstick::solver
