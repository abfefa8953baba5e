#include "solver/grid/threads.hpp"

#include <fmt/core.h>

#include <atomic>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>

namespace slipstick::solver {
namespace {

/// The pool of this thread.
thread_local ThreadPool* current = nullptr;

/// Polls before a thread sleeps: loops follow each other within microseconds, and waking takes tens of them.
constexpr int kPolls = 500;

template <typename Value>
void wait_while(const std::atomic<Value>& value, Value old) {
  for (int poll = 0; poll < kPolls; ++poll) {
    if (value.load() != old) return;
    std::this_thread::yield();
  }
  value.wait(old);
}

}  // namespace

/// The parts of a job. The calling thread takes parts from the last one down, the others from the first one
/// up, so that the caller does the part of a thread that has no processor instead of waiting for it.
struct ThreadPool::Shared {
  /// The parts that no thread has taken yet.
  struct Parts {
    std::uint16_t first;
    std::uint16_t last;
    bool operator==(const Parts&) const = default;
  };
  static constexpr Parts kStop{0xFFFF, 0xFFFF};
  std::atomic<Parts> left = Parts{0, 0};
  std::atomic<int> pending = 0;  ///< parts that are not done
  Job job{};

  /// Takes one and does it; false if none is left.
  bool do_part(bool last) {
    Parts parts = left.load();
    Parts rest{};
    do {
      if (parts.first == parts.last) return false;
      rest = parts;
      if (last) {
        --rest.last;
      } else {
        ++rest.first;
      }
    } while (!left.compare_exchange_weak(parts, rest));
    job(last ? rest.last : parts.first);
    if (pending.fetch_sub(1) == 1) pending.notify_one();
    return true;
  }
};

ThreadPool::ThreadPool() : shared_(std::make_unique<Shared>()), outer_(std::exchange(current, this)) {}

/// The delegation makes the destructor run, and stop the started threads, if another one cannot start.
ThreadPool::ThreadPool(int threads) : ThreadPool() {
  try {
    while (available() < threads) others_.emplace_back([this] { work(); });
  } catch (const std::exception&) {
    throw std::runtime_error(
        fmt::format("solver.threads = {}: allowed: up to {} here, where the limits of memory and processes let "
                    "no more start",
                    threads, available()));
  }
}

ThreadPool::~ThreadPool() {
  current = outer_;
  shared_->left = Shared::kStop;
  shared_->left.notify_all();
}

void ThreadPool::work() {
  Shared& shared = *shared_;
  for (;;) {
    const Shared::Parts left = shared.left.load();
    if (left == Shared::kStop) return;
    if (!shared.do_part(false)) wait_while(shared.left, left);
  }
}

int ThreadPool::available() { return current ? static_cast<int>(current->others_.size()) + 1 : 1; }

void ThreadPool::run(int threads, Job job) {
  std::optional<ThreadPool> own;
  if (!current) own.emplace(threads);
  Shared& shared = *current->shared_;
  shared.job = job;
  shared.pending = threads;
  shared.left = Shared::Parts{0, static_cast<std::uint16_t>(threads)};
  shared.left.notify_all();
  while (shared.do_part(true)) {
  }
  for (int pending = shared.pending.load(); pending > 0; pending = shared.pending.load()) {
    wait_while(shared.pending, pending);
  }
}

}  // namespace slipstick::solver
