#include <mpi.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "solver/mpi/communicator.hpp"

/// libslipstick_ranks: MPI.
namespace slipstick::solver {
namespace {

/// The things of one rank: [first, last).
struct Part {
  Index first;
  Index last;
  int count() const { return static_cast<int>(last - first); }
};
Part part_of(int rank, Index count, Index of_rank) {
  return {std::min(rank * of_rank, count), std::min((rank + 1) * of_rank, count)};
}
/// The intersection of two parts, and a part with `depth` neighbours on each side.
Part within(Part part, Part other) {
  const Index first = std::max(part.first, other.first);
  return {first, std::max(first, std::min(part.last, other.last))};
}
Part widened(Part part, Index depth) { return part.count() == 0 ? part : Part{part.first - depth, part.last + depth}; }

/// MPI counts in int, which many bytes would not fit: things of several bytes are counted instead.
class Thing {
 public:
  explicit Thing(std::size_t bytes) {
    MPI_Type_contiguous(static_cast<int>(bytes), MPI_BYTE, &type_);
    MPI_Type_commit(&type_);
  }
  ~Thing() { MPI_Type_free(&type_); }
  Thing(const Thing&) = delete;
  Thing& operator=(const Thing&) = delete;
  operator MPI_Datatype() const { return type_; }

 private:
  MPI_Datatype type_ = MPI_DATATYPE_NULL;
};

class MpiCommunicator final : public Communicator {
 public:
  MpiCommunicator() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &number_);
    MPI_Comm_dup(MPI_COMM_WORLD, &ends_);
  }
  ~MpiCommunicator() override {
    MPI_Comm_free(&ends_);
    MPI_Finalize();
  }

  int number() const override { return number_; }
  int rank() const override { return rank_; }
  Sent sent() const override { return sent_; }

  void gather(void* things, std::size_t bytes, Index count, Index of_rank) override {
    std::vector<int> counts;
    std::vector<int> starts;
    for (int rank = 0; rank < number_; ++rank) {
      const Part part = part_of(rank, count, of_rank);
      starts.push_back(static_cast<int>(part.first));
      counts.push_back(part.count());
    }
    MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, things, counts.data(), starts.data(), Thing(bytes),
                   MPI_COMM_WORLD);
    for (int other = 1; other < number_; ++other) add_sent(bytes, part_of(rank_, count, of_rank).count());
  }

  /// Where ranks have fewer things than `depth`, neighbours belong to several ranks.
  void gather_adjacent(void* things, std::size_t bytes, Index count, Index of_rank, Index depth) override {
    const Thing thing(bytes);
    const Part own = part_of(rank_, count, of_rank);
    std::vector<MPI_Request> requests;
    const auto at = [&](const Part& part) {
      return static_cast<std::byte*>(things) + static_cast<std::size_t>(part.first) * bytes;
    };
    for (int other = 0; other < number_; ++other) {
      if (other == rank_) continue;
      const Part theirs = part_of(other, count, of_rank);
      if (const Part wanted = within(theirs, widened(own, depth)); wanted.count() > 0) {
        MPI_Irecv(at(wanted), wanted.count(), thing, other, 0, MPI_COMM_WORLD, &requests.emplace_back());
      }
      if (const Part asked = within(own, widened(theirs, depth)); asked.count() > 0) {
        MPI_Isend(at(asked), asked.count(), thing, other, 0, MPI_COMM_WORLD, &requests.emplace_back());
        add_sent(bytes, asked.count());
      }
    }
    MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  }

  /// Pairs of ranks exchange blocks, so that a received block replaces the one that was sent.
  void transpose(void* buffer, const SharedMatrix& matrix, bool to_columns) override {
    for (int round = 0; round < number_; ++round) {
      const int other = (round - rank_ + number_) % number_;
      if (other == rank_) continue;
      const auto block = [&](int rows_of, int columns_of) -> Block {
        return {part_of(rows_of, matrix.rows, matrix.rows_of_rank).count(),
                static_cast<std::size_t>(part_of(columns_of, matrix.columns, matrix.columns_of_rank).count()) *
                    matrix.entry};
      };
      const Block rows = block(rank_, other);
      const Block columns = block(other, rank_);
      auto* const start =
          static_cast<std::byte*>(buffer) + static_cast<std::size_t>(other * matrix.columns_of_rank) * matrix.entry;
      to_columns ? exchange(start, matrix.row, other, rows, columns)
                 : exchange(start, matrix.row, other, columns, rows);
    }
  }

  bool have_all_ended() override {
    if (ending_ == MPI_REQUEST_NULL) MPI_Ibarrier(ends_, &ending_);
    int ended = 0;
    MPI_Test(&ending_, &ended, MPI_STATUS_IGNORE);
    return ended != 0;
  }
  [[noreturn]] void abort(int exit_code) override {
    MPI_Abort(MPI_COMM_WORLD, exit_code);
    std::abort();
  }

 private:
  /// Rows of a matrix, and their bytes.
  struct Block {
    Index rows;
    std::size_t bytes;
    bool empty() const { return rows == 0 || bytes == 0; }
  };
  /// Bytes of a message, or one row if that is longer: they stay in cache while they are packed.
  static constexpr std::size_t kPiece = std::size_t{1} << 20;

  /// Sends one block of this rank's and puts another in its place, from the same rank.
  void exchange(std::byte* start, std::size_t stride, int other, const Block& mine, const Block& theirs) {
    const std::size_t widest = std::max(mine.bytes, theirs.bytes);
    if (widest == 0) return;
    const Index piece = std::max<Index>(static_cast<Index>(kPiece / widest), 1);
    outgoing_.resize(static_cast<std::size_t>(piece) * widest);
    incoming_.resize(outgoing_.size());
    const auto row = [&](Index i) { return start + static_cast<std::size_t>(i) * stride; };
    const auto rows_from = [&](const Block& block, Index first) {
      return block.empty() ? 0 : std::clamp<Index>(block.rows - first, 0, piece);
    };
    const Thing sent(std::max<std::size_t>(mine.bytes, 1));
    const Thing received(std::max<std::size_t>(theirs.bytes, 1));
    for (Index first = 0;; first += piece) {
      const Index out = rows_from(mine, first);
      const Index in = rows_from(theirs, first);
      if (out == 0 && in == 0) return;
      for (Index i = 0; i < out; ++i) {
        std::memcpy(outgoing_.data() + static_cast<std::size_t>(i) * mine.bytes, row(first + i), mine.bytes);
      }
      MPI_Sendrecv(outgoing_.data(), static_cast<int>(out), sent, out > 0 ? other : MPI_PROC_NULL, 1, incoming_.data(),
                   static_cast<int>(in), received, in > 0 ? other : MPI_PROC_NULL, 1, MPI_COMM_WORLD,
                   MPI_STATUS_IGNORE);
      for (Index i = 0; i < in; ++i) {
        std::memcpy(row(first + i), incoming_.data() + static_cast<std::size_t>(i) * theirs.bytes, theirs.bytes);
      }
      add_sent(mine.bytes, out);
    }
  }
  void add_sent(std::size_t bytes, Index things) {
    sent_.bytes += static_cast<double>(bytes) * static_cast<double>(things);
    sent_.messages += things > 0 ? 1.0 : 0.0;
  }

  int number_ = 1;
  int rank_ = 0;
  Sent sent_;
  std::vector<std::byte> outgoing_, incoming_;
  MPI_Comm ends_ = MPI_COMM_NULL;  ///< for have_all_ended() only, so that no other message disturbs it
  MPI_Request ending_ = MPI_REQUEST_NULL;
};

}  // namespace

extern "C" [[gnu::visibility("default")]] Communicator* slipstick_ranks() { return new MpiCommunicator; }

}  // namespace slipstick::solver
