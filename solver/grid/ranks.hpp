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

/// The processes that solve one contact together, as one of them sees them: this process alone, or the ranks
/// of MPI that mpirun has started. Each grid carries this value, which says whose its rows are. It refers to
/// the JoinedRanks or PlannedRanks that it comes from, which live longer. All ranks call its functions alike.
///
/// Every rank knows a field by the same addresses, of all its cells. Where ranks share the work each holds
/// what its own rows have, and the memory of the others' rows is not touched, so that the system never gives
/// it; share_rows() makes a field whole.
class Ranks {
 public:
  /// This process alone.
  Ranks() = default;
  explicit Ranks(Communicator& communicator) : communicator_(&communicator) {}

  bool several() const { return communicator_ != nullptr; }
  int number() const;
  /// The number of this process, from 0.
  int rank() const;
  /// Whether this is the process that prints and writes files.
  bool first() const { return rank() == 0; }

  /// What one rank of so many has of a count, in equal blocks, the last ones smaller or empty.
  static IndexRange share(Index count, int rank, int number) {
    const Index block = block_of(count, number);
    return {std::min(rank * block, count), std::min((rank + 1) * block, count)};
  }
  IndexRange own_share(Index count) const { return share(count, rank(), number()); }
  Index block_of(Index count) const { return block_of(count, number()); }

  /// Makes a field of some rows whole on every rank, each of which has so many rows, the last ones fewer.
  void gather(std::span<double> field, Index rows, Index rows_of_rank) const;
  /// Brings the rows next to this rank's from the ranks that have them, so many on each side.
  void gather_beside(std::span<double> field, Index rows, Index rows_of_rank, Index depth) const;
  /// Makes a row of things whole, of which each rank has its share().
  template <typename Thing>
  void gather_shares(std::span<Thing> things) const {
    gather_shares(things.data(), sizeof(Thing), static_cast<Index>(things.size()));
  }
  /// One number of each rank, on all of them.
  std::vector<double> of_each(double own) const;
  /// A text of the first rank, of less than 8 KiB, on all of them.
  std::string of_first(const std::string& own) const;

  /// How several ranks reach each other. Throws std::logic_error for one process alone.
  Communicator& communicator() const;

 private:
  static Index block_of(Index count, int number) { return (count + number - 1) / number; }
  void gather_shares(void* things, std::size_t bytes, Index count) const;

  Communicator* communicator_ = nullptr;
};

/// The ranks that mpirun has started, if it has, joined as long as this object lives. The program makes it
/// once, and uses what comes from it on the thread that made it.
class JoinedRanks {
 public:
  /// Throws std::runtime_error where the library for several ranks is not there.
  JoinedRanks();
  ~JoinedRanks();
  JoinedRanks(const JoinedRanks&) = delete;
  JoinedRanks& operator=(const JoinedRanks&) = delete;

  Ranks ranks() const { return communicator_ ? Ranks(*communicator_) : Ranks(); }
  /// Waits for the other ranks. A rank that failed waits for some seconds: where the others go on without it,
  /// it says why and ends them all with its exit code.
  void end(int exit_code, const std::string& failure = {});

 private:
  std::unique_ptr<Communicator> communicator_;
};

/// The first of so many ranks, of which no other exists: for predictions. They share no work, and throw
/// std::logic_error where they are asked to.
class PlannedRanks {
 public:
  explicit PlannedRanks(int number);
  ~PlannedRanks();
  PlannedRanks(const PlannedRanks&) = delete;
  PlannedRanks& operator=(const PlannedRanks&) = delete;

  Ranks ranks() const { return Ranks(*communicator_); }

 private:
  std::unique_ptr<Communicator> communicator_;
};

}  // namespace slipstick::solver
