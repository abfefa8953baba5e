#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace slipstick::solver {

using Eigen::Index;

/// A matrix that ranks share, with entries of some bytes each. Every rank has rows_of_rank of its rows, the
/// last ranks fewer or none; likewise of its columns.
struct SharedMatrix {
  Index rows;
  Index rows_of_rank;
  Index columns;
  Index columns_of_rank;
  std::size_t entry;  ///< bytes
  std::size_t row;    ///< bytes from one row to the next: columns_of_rank entries for each rank, at least
};

/// How ranks reach each other: what the library that knows MPI does for them. All ranks call each of these
/// functions alike.
class Communicator {
 public:
  virtual ~Communicator() = default;
  Communicator(const Communicator&) = delete;
  Communicator& operator=(const Communicator&) = delete;

  virtual int number() const = 0;
  virtual int rank() const = 0;

  /// Brings all of `count` things of some bytes each to every rank. Every rank has of_rank of them in their
  /// place, the last ranks fewer.
  virtual void gather(void* things, std::size_t bytes, Index count, Index of_rank) = 0;
  /// Brings those of such things that are next to this rank's, `depth` of them on each side.
  virtual void gather_beside(void* things, std::size_t bytes, Index count, Index of_rank, Index depth) = 0;

  /// Transposes such a matrix between ranks, in place: from this rank's rows, of all columns, to its columns,
  /// of all rows, and back. What other ranks have in this one's columns comes where this one has theirs: row
  /// i of rank r stands in row i of the buffer, from column r * columns_of_rank on.
  virtual void transpose(void* buffer, const SharedMatrix& matrix, bool to_columns) = 0;

  /// Bytes and messages that this rank has sent to others so far.
  struct Sent {
    double bytes = 0.0;
    double messages = 0.0;
  };
  virtual Sent sent() const = 0;

  /// Whether all ranks have called this, which need not be at the same time.
  virtual bool have_all_ended() = 0;
  /// Ends all ranks.
  [[noreturn]] virtual void abort(int exit_code) = 0;

 protected:
  Communicator() = default;
};

}  // namespace slipstick::solver
