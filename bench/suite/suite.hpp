#pragma once

#include <benchmark/benchmark.h>

#include <concepts>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "solver/grid/grid.hpp"

namespace slipstick::bench {

using Timing = std::function<void(benchmark::State&)>;  ///< the loop over iterations

/// A benchmark, set up and checked.
struct Prepared {
  std::map<std::string, benchmark::Counter> counters = {};
  std::string invalid_reason = {};  ///< why its result must not be timed; empty: nothing
  Timing timing = {};
};

template <typename Work>
Timing repeated(Work work) {
  return [work](benchmark::State& state) mutable {
    for ([[maybe_unused]] auto _ : state) work();
  };
}

/// A counter of work per second; the argument is the work of one iteration.
inline benchmark::Counter rate(double of_one_iteration) {
  return {of_one_iteration, benchmark::Counter::kIsIterationInvariantRate};
}

/// Google Benchmark calls a benchmark's function for each repetition, and before that until it knows how many
/// iterations fill the time. Setting up and checking is for the first call only, and of all benchmarks the
/// latest one's result is kept, as a dense matrix is large. Must outlive the runs.
class Suite {
 public:
  using Prepare = std::function<Prepared()>;

  /// An exception in `prepare` is a reason not to time.
  benchmark::internal::Benchmark* add(const std::string& name, Prepare prepare);
  /// A benchmark for each number of cells along a side.
  void add_sizes(const std::string& family, const std::vector<solver::Index>& sizes,
                 const std::invocable<solver::Index> auto& prepare) {
    for (const solver::Index cells : sizes)
      add(family + "/cells:" + std::to_string(cells), [prepare, cells] { return prepare(cells); });
  }

 private:
  struct Entry {
    std::string name;
    Prepare prepare;
  };

  void run(benchmark::State& state, const Entry& entry);

  std::deque<Entry> entries_;  ///< stay where they are
  const Entry* latest_ = nullptr;
  Prepared prepared_;
};

/// The program's benchmarks, file by file.
void add_influence_benchmarks(Suite& suite);
void add_operator_benchmarks(Suite& suite);
void add_solve_benchmarks(Suite& suite);
void add_exact_benchmarks(Suite& suite);

}  // namespace slipstick::bench
