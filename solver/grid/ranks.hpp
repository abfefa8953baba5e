#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace slipstick::solver {

using Eigen::Index;

class Communicator;

/// The indices first, first + 1, ..., last - 1.
struct IndexRange {
  Index first;
  Index last;
  Index count() const { return last - first; }
  bool operator==(const IndexRange&) const = default;
};

/// The processes that solve one contact together: one process, or the ranks of MPI that mpirun has started.
/// Each grid carries this value, which determines the owner of each row. It refers to the JoinedRanks that
/// made it, which must live longer. Its functions are collective: all ranks call them.
///
/// Every rank has an array for the whole field but fills only its own rows; the pages of other rows are never
/// touched, so that they take no memory. share_rows() makes a field whole.
class Ranks {
 public:
  /// One process.
  Ranks() = default;
  explicit Ranks(Communicator& communicator) : communicator_(&communicator) {}
  /// Rank 0 of `number` ranks, for predictions: the others do not exist, so that any exchange throws std::logic_error.
  static Ranks planned(int number) {
    Ranks ranks;
    ranks.planned_ = number;
    return ranks;
  }

  bool operator==(const Ranks&) const = default;
  bool several() const { return communicator_ != nullptr || planned_ > 1; }
  int number() const;
  /// The number of this process, from 0.
  int rank() const;
  /// True for the process that prints and writes files.
  bool first() const { return rank() == 0; }

  /// The part of [0, count) that one of `number` ranks owns: equal blocks, the last ones smaller or empty.
  static IndexRange share(Index count, int rank, int number) {
    const Index block = block_of(count, number);
    return {std::min(rank * block, count), std::min((rank + 1) * block, count)};
  }
  IndexRange own_share(Index count) const { return share(count, rank(), number()); }
  Index block_of(Index count) const { return block_of(count, number()); }

  /// Makes a field of `rows` rows whole on every rank. Each rank has rows_of_rank rows, the last ones fewer.
  void gather(std::span<double> field, Index rows, Index rows_of_rank) const;
  /// Brings `depth` rows on each side of this rank's rows from the ranks that have them.
  void gather_adjacent(std::span<double> field, Index rows, Index rows_of_rank, Index depth) const;
  /// Makes an array whole on every rank. Each rank has its share().
  template <typename Thing>
  void gather_shares(std::span<Thing> things) const {
    gather_shares(things.data(), sizeof(Thing), static_cast<Index>(things.size()));
  }
  /// One number of each rank, on all of them.
  std::vector<double> of_each(double own) const;
  /// A text of the first rank, of less than 8 KiB, on all of them.
  std::string of_first(const std::string& own) const;

  /// Throws std::logic_error where there is none.
  Communicator& communicator() const;

 private:
  static Index block_of(Index count, int number) { return (count + number - 1) / number; }
  void gather_shares(void* things, std::size_t bytes, Index count) const;

  Communicator* communicator_ = nullptr;
  int planned_ = 1;
};

/// Connects the ranks that mpirun has started, if any, for the lifetime of this object. The program makes it
/// once and uses its ranks only on that thread.
class JoinedRanks {
 public:
  /// Throws std::runtime_error if the library for several ranks is missing.
  JoinedRanks();
  ~JoinedRanks();
  JoinedRanks(const JoinedRanks&) = delete;
  JoinedRanks& operator=(const JoinedRanks&) = delete;

  Ranks ranks() const { return communicator_ ? Ranks(*communicator_) : Ranks(); }
  /// Waits for the other ranks. A rank that failed waits for 10 seconds; if others still run, it prints the
  /// failure and aborts them all with its exit code.
  void end(int exit_code, const std::string& failure = {});

 private:
  std::unique_ptr<Communicator> communicator_;
};

}  // namespace slipstick::solver
