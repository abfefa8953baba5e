#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "convergence/runs/result_cache.hpp"
#include "convergence/runs/run_spec.hpp"
#include "convergence/system/run_program.hpp"
#include "solver/cache/solve_cache.hpp"

namespace slipstick::convergence {

/// The exit code of a worker that cannot write its result, or the fields that belong to it.
inline constexpr int kNotKept = 3;

/// A slipstick process that solves runs one after another and keeps their results in a folder. Tables and
/// plans that several runs need are made once. The process ends with this one, see ProgramOptions::tied_by,
/// and after a run that fails; the destructor kills a process that is still running.
class Worker {
 public:
  /// memory_limit: bytes that one run may take; none: the memory that is free.
  Worker(const std::filesystem::path& program, const std::filesystem::path& folder, std::optional<double> memory_limit);

  /// Starts a run, once the one before is finished. Where the process has ended, next() returns that.
  void start(const RunSpec& run);

  /// The descriptor to poll before next().
  int output() const { return program_.output(); }

  /// Reads: a part of a message, the end of its run, or the end of the process.
  enum class Event { output, finished, ended };
  Event next();

  /// Lets the process end after its run, where it has not ended, and waits for its end.
  ProgramEnd wait();

 private:
  Program program_;
};

/// Solves a run, on one thread unless its scene sets more, and keeps its result. Throws InputError where
/// a file cannot be written, and as serve_runs().
void keep_result_of(PreparedRun run, std::optional<double> memory_limit,
                    const std::shared_ptr<solver::SolveCache>& shared, const ResultCache& cache);

/// The main loop of a worker: solves the runs that come on standard input, and writes on standard output when each is
/// finished. Returns its exit code: kNotKept where a file cannot be written, with a message on standard error. Throws
/// std::runtime_error if memory runs out, OutOfMemory for a solve that would take more than `memory_limit`.
int serve_runs(const std::filesystem::path& folder, std::optional<double> memory_limit);

}  // namespace slipstick::convergence
