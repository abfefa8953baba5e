#include "solver/grid/ranks.hpp"

#include <malloc.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "cmake/loaded_library.hpp"
#include "solver/mpi/communicator.hpp"

namespace slipstick::solver {
namespace {

/// mpirun and srun set one of these to the number of processes.
constexpr std::array kNumberVariables{"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"};
/// Blocks of more bytes are mapped by themselves: pages take memory only once touched, and are unmapped when
/// the block is freed.
constexpr int kOwnMemory = 1 << 20;
/// Bytes at the end of the heap that stay with the process when they are freed.
constexpr int kKeptAtEnd = 64 << 20;
/// Ranks that fail for the same reason end within a moment of each other.
constexpr std::chrono::seconds kOthersEnd{10};

int started() {
  for (const char* name : kNumberVariables) {
    if (const char* number = std::getenv(name)) return std::atoi(number);
  }
  return 1;
}

}  // namespace

int Ranks::number() const { return communicator_ != nullptr ? communicator_->number() : planned_; }
int Ranks::rank() const { return communicator_ != nullptr ? communicator_->rank() : 0; }

Communicator& Ranks::communicator() const {
  if (communicator_ == nullptr) throw std::logic_error("ranks without a communicator");
  return *communicator_;
}

void Ranks::gather(std::span<double> field, Index rows, Index rows_of_rank) const {
  if (!several() || rows == 0) return;
  communicator().gather(field.data(), field.size_bytes() / static_cast<std::size_t>(rows), rows, rows_of_rank);
}

void Ranks::gather_adjacent(std::span<double> field, Index rows, Index rows_of_rank, Index depth) const {
  if (!several() || rows == 0) return;
  communicator().gather_adjacent(field.data(), field.size_bytes() / static_cast<std::size_t>(rows), rows, rows_of_rank,
                                 depth);
}

void Ranks::gather_shares(void* things, std::size_t bytes, Index count) const {
  if (several()) communicator().gather(things, bytes, count, block_of(count));
}

std::vector<double> Ranks::of_each(double own) const {
  std::vector<double> all(static_cast<std::size_t>(number()), own);
  gather_shares(std::span(all));
  return all;
}

std::string Ranks::of_first(const std::string& own) const {
  std::vector<std::array<char, 8192>> all(static_cast<std::size_t>(number()));
  auto& text = all[static_cast<std::size_t>(rank())];
  own.copy(text.data(), text.size() - 1);
  gather_shares(std::span(all));
  return all.front().data();
}

JoinedRanks::JoinedRanks() {
  if (started() <= 1) return;
  try {
    communicator_.reset(loaded_library<Communicator>("slipstick_ranks", RTLD_GLOBAL));
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(
        "started on several ranks, for which this build has no library; build it with "
        "SLIPSTICK_MPI=ON, or start one process: " +
        std::string(error.what()));
  }
  if (communicator_->number() == 1) {
    communicator_.reset();
    throw std::runtime_error(
        "started on several ranks, but each finds only itself: this mpirun belongs to another MPI than "
        "this build; use the mpirun of the build's MPI");
  }
  mallopt(M_MMAP_THRESHOLD, kOwnMemory);
  mallopt(M_TRIM_THRESHOLD, kKeptAtEnd);
  for (const char* name : kNumberVariables) unsetenv(name);  // programs that this one starts are no ranks
}

JoinedRanks::~JoinedRanks() = default;

void JoinedRanks::end(int exit_code, const std::string& failure) {
  if (!communicator_) return;
  const auto start = std::chrono::steady_clock::now();
  while (!communicator_->have_all_ended()) {
    if (!failure.empty() && std::chrono::steady_clock::now() - start > kOthersEnd) {
      std::fprintf(stderr, "slipstick: rank %d ends the run: %s\n", communicator_->rank(), failure.c_str());
      communicator_->abort(exit_code);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace slipstick::solver
