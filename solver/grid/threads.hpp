#pragma once

#include <memory>
#include <thread>
#include <vector>

#include "solver/grid/grid.hpp"

namespace slipstick::solver {

/// The threads of one solve, which wait for work while this object lives. Loops on the thread that made it
/// run on them; a loop without a pool starts its own.
class ThreadPool {
 public:
  /// threads: in all, with the one that makes the pool. A pool made within another one replaces it for its
  /// lifetime. Throws std::runtime_error if not all threads can start.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// Number of threads for the loops of the calling thread: its pool's, or 1.
  static int available();

  /// The work of each thread, by its number.
  struct Job {
    void (*call)(const void* work, int thread);
    const void* work;
    void operator()(int thread) const { call(work, thread); }
  };
  /// Runs `threads` parts of the job on the available threads. The job must not throw.
  static void run(int threads, Job job);

 private:
  struct Shared;
  ThreadPool();
  void work();

  std::unique_ptr<Shared> shared_;
  std::vector<std::jthread> others_;
  ThreadPool* outer_;
};

/// Cuts [0, count) into as many contiguous parts as there are threads and calls work(thread, first, last) on
/// each at the same time, the last part on the calling thread. The parts do not depend on timing, so results
/// do not either. In a pool, or with one thread, it allocates nothing. The work must not throw.
template <typename Work>
void in_parts(int threads, Index count, const Work& work) {
  const auto part = [&](int thread) { work(thread, count * thread / threads, count * (thread + 1) / threads); };
  if (threads <= 1) {
    work(0, Index(0), count);
    return;
  }
  const auto call = [](const void* with, int thread) { (*static_cast<const decltype(part)*>(with))(thread); };
  ThreadPool::run(threads, {call, &part});
}

}  // namespace slipstick::solver
