#include "solver/grid/threads.hpp"

#include <atomic>
#include <utility>

namespace slipstick::solver {
namespace {

/// Of this thread.
thread_local ThreadPool* current = nullptr;

}  // namespace

/// A run is one more generation: each thread does its part of the job and counts itself off.
struct ThreadPool::Shared {
  std::atomic<unsigned> generation = 0;
  std::atomic<int> pending = 0;
  Job job{};  ///< of this generation
  int threads = 0;
  bool stop = false;
};

ThreadPool::ThreadPool(int threads)
    : shared_(std::make_unique<Shared>()), outer_(std::exchange(current, this)) {
  for (int thread = 0; thread + 1 < threads; ++thread) {
    others_.emplace_back([this, thread] { work(thread); });
  }
}

ThreadPool::~ThreadPool() {
  current = outer_;
  shared_->stop = true;
  shared_->generation.fetch_add(1);
  shared_->generation.notify_all();
}

void ThreadPool::work(int thread) {
  Shared& shared = *shared_;
  for (unsigned seen = 0;;) {
    shared.generation.wait(seen);
    seen = shared.generation.load();
    if (shared.stop) return;
    if (thread + 1 < shared.threads) shared.job(thread);
    if (shared.pending.fetch_sub(1) == 1) shared.pending.notify_one();
  }
}

int ThreadPool::available() { return current ? static_cast<int>(current->others_.size()) + 1 : 1; }

void ThreadPool::run(int threads, Job job) {
  if (threads > available()) {
    std::vector<std::jthread> others;
    for (int thread = 0; thread + 1 < threads; ++thread) others.emplace_back([=] { job(thread); });
    job(threads - 1);
    return;
  }
  Shared& shared = *current->shared_;
  shared.job = job;
  shared.threads = threads;
  shared.pending = static_cast<int>(current->others_.size());
  shared.generation.fetch_add(1);
  shared.generation.notify_all();
  job(threads - 1);
  for (int left = shared.pending.load(); left > 0; left = shared.pending.load()) shared.pending.wait(left);
}

}  // namespace slipstick::solver
