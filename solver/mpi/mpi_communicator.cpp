#include <fftw3-mpi.h>
#include <mpi.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <vector>

#include "solver/fft/fftw.hpp"
#include "solver/grid/communicator.hpp"

/// libslipstick_ranks: MPI, and the transposes of FFTW's MPI library.
namespace slipstick::solver {
namespace {

using Length = std::ptrdiff_t;

/// The things of one rank: [first, last).
struct Part {
  Index first;
  Index last;
  int count() const { return static_cast<int>(last - first); }
};
Part part_of(int rank, Index count, Index of_rank) {
  return {std::min(rank * of_rank, count), std::min((rank + 1) * of_rank, count)};
}
/// The part that is in another one, and a part with what is next to it.
Part within(Part part, Part other) {
  const Index first = std::max(part.first, other.first);
  return {first, std::max(first, std::min(part.last, other.last))};
}
Part widened(Part part, Index depth) {
  return part.count() == 0 ? part : Part{part.first - depth, part.last + depth};
}

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
    fftw_mpi_init();
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

  /// With few things a rank whoever has those next to it is not always the next rank.
  void gather_beside(void* things, std::size_t bytes, Index count, Index of_rank, Index depth) override {
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

  std::size_t size(const SharedMatrix& matrix) const override {
    const std::array<Length, 2> sides{matrix.rows, matrix.columns};
    std::array<Length, 4> own{};
    const Length reals = fftw_mpi_local_size_many_transposed(
        2, sides.data(), reals_of_entry(matrix), matrix.rows_of_rank, matrix.columns_of_rank, MPI_COMM_WORLD,
        &own[0], &own[1], &own[2], &own[3]);
    return sizeof(double) * static_cast<std::size_t>(std::max<Length>(reals, reals_of_entry(matrix)));
  }

  std::unique_ptr<Transposition> transposition(const SharedMatrix& matrix) override;

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
  friend class FftwTransposition;
  static Length reals_of_entry(const SharedMatrix& matrix) {
    return static_cast<Length>(matrix.entry / sizeof(double));
  }
  void add_sent(std::size_t bytes, Length things) {
    sent_.bytes += static_cast<double>(bytes) * static_cast<double>(things);
    sent_.messages += things > 0 ? 1.0 : 0.0;
  }

  int number_ = 1;
  int rank_ = 0;
  Sent sent_;
  MPI_Comm ends_ = MPI_COMM_NULL;  ///< whatever ranks wait for elsewhere
  MPI_Request ending_ = MPI_REQUEST_NULL;
};

/// Entries are moved as numbers in double precision, whatever they are.
class FftwTransposition final : public Transposition {
 public:
  FftwTransposition(MpiCommunicator& ranks, const SharedMatrix& matrix) : ranks_(ranks), matrix_(matrix) {
    FftwBuffer buffer(ranks.size(matrix) / sizeof(double));
    const auto plan = [&](Length rows, Length of_rank, Length columns, Length columns_of_rank) {
      return FftwPlan(fftw_mpi_plan_many_transpose(rows, columns, MpiCommunicator::reals_of_entry(matrix),
                                                   of_rank, columns_of_rank, buffer.data(), buffer.data(),
                                                   MPI_COMM_WORLD, FFTW_ESTIMATE));
    };
    to_columns_ = plan(matrix.rows, matrix.rows_of_rank, matrix.columns, matrix.columns_of_rank);
    to_rows_ = plan(matrix.columns, matrix.columns_of_rank, matrix.rows, matrix.rows_of_rank);
  }

  void to_columns(void* buffer) override {
    run(to_columns_, buffer);
    const Part own = part_of(ranks_.rank(), matrix_.rows, matrix_.rows_of_rank);
    add_sent(own, matrix_.columns, matrix_.columns_of_rank);
  }
  void to_rows(void* buffer) override {
    run(to_rows_, buffer);
    const Part own = part_of(ranks_.rank(), matrix_.columns, matrix_.columns_of_rank);
    add_sent(own, matrix_.rows, matrix_.rows_of_rank);
  }

 private:
  static void run(const FftwPlan& plan, void* buffer) {
    auto* const reals = static_cast<double*>(buffer);
    fftw_mpi_execute_r2r(plan.get(), reals, reals);
  }
  void add_sent(const Part& own, Index across, Index across_of_rank) {
    for (int other = 0; other < ranks_.number(); ++other) {
      if (other == ranks_.rank()) continue;
      ranks_.add_sent(matrix_.entry, Length(own.count()) * part_of(other, across, across_of_rank).count());
    }
  }

  MpiCommunicator& ranks_;
  SharedMatrix matrix_;
  FftwPlan to_columns_;
  FftwPlan to_rows_;
};

std::unique_ptr<Transposition> MpiCommunicator::transposition(const SharedMatrix& matrix) {
  return std::make_unique<FftwTransposition>(*this, matrix);
}

}  // namespace

extern "C" [[gnu::visibility("default")]] Communicator* slipstick_ranks() { return new MpiCommunicator; }

}  // namespace slipstick::solver
