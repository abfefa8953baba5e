#pragma once

#include <memory>

#include "solver/grid/communicator.hpp"
#include "solver/grid/own_rows.hpp"

namespace slipstick::solver {

/// What a transform carries between ranks, between its pass over rows and that over columns; on one rank,
/// which keeps all, it does nothing. Entries are some numbers that stay together.
class RankTranspose {
 public:
  struct Shape {
    Ranks ranks;
    Index rows;
    Index rows_of_rank;
    Index columns;
    Index entry;

    Share own_columns() const { return ranks.own_share(columns); }
    SharedMatrix matrix() const {
      return {rows, rows_of_rank, columns, ranks.block_of(columns),
              static_cast<std::size_t>(entry) * sizeof(double)};
    }
    /// What all ranks together send for one way.
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
    /// Numbers in this rank's part, rounded up to cache lines.
    Index size() const {
      if (!ranks.several()) return rows * columns * entry;
      constexpr Index line = 64 / static_cast<Index>(sizeof(double));
      const auto bytes = ranks.communicator().size(matrix());
      return (static_cast<Index>(bytes / sizeof(double)) + line - 1) / line * line;
    }
  };

  explicit RankTranspose(const Shape& shape) {
    if (shape.ranks.several()) transposition_ = shape.ranks.communicator().transposition(shape.matrix());
  }

  void to_columns(double* buffer) const {
    if (transposition_) transposition_->to_columns(buffer);
  }
  void to_rows(double* buffer) const {
    if (transposition_) transposition_->to_rows(buffer);
  }

 private:
  std::unique_ptr<Transposition> transposition_;
};

}  // namespace slipstick::solver
