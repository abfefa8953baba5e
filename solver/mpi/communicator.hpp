#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace slipstick::solver {

using Eigen::Index;

/// A matrix that ranks share. Every rank has rows_of_rank rows and columns_of_rank columns, the last ranks
/// fewer or none.
struct SharedMatrix {
  Index rows;
  Index rows_of_rank;
  Index columns;
  Index columns_of_rank;
  std::size_t entry;  ///< bytes
  std::size_t row;    ///< bytes from one row to the next: columns_of_rank entries for each rank, at least
};

/// The communication between ranks, which libslipstick_ranks implements by MPI. All functions are collective.
class Communicator {
 public:
  virtual ~Communicator() = default;
  Communicator(const Communicator&) = delete;
  Communicator& operator=(const Communicator&) = delete;

  virtual int number() const = 0;
  virtual int rank() const = 0;

  /// Brings all `count` things of `bytes` bytes each to every rank. Every rank has of_rank of them in their
  /// place, the last ranks fewer.
  virtual void gather(void* things, std::size_t bytes, Index count, Index of_rank) = 0;
  /// Brings only the `depth` things on each side of this rank's.
  virtual void gather_adjacent(void* things, std::size_t bytes, Index count, Index of_rank, Index depth) = 0;

  /// Transposes the matrix between ranks, in place: from this rank's rows, of all columns, to its columns, of
  /// all rows, or back. After to_columns, row i of rank r is in row i of the buffer, from column
  /// r * columns_of_rank on.
  virtual void transpose(void* buffer, const SharedMatrix& matrix, bool to_columns) = 0;

  /// Bytes and messages that this rank has sent to others so far.
  struct Sent {
    double bytes = 0.0;
    double messages = 0.0;
  };
  virtual Sent sent() const = 0;

  /// True once all ranks have called this; it does not wait.
  virtual bool have_all_ended() = 0;
  /// Ends all ranks.
  [[noreturn]] virtual void abort(int exit_code) = 0;

 protected:
  Communicator() = default;
};

}  // namespace slipstick::solver
