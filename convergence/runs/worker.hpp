#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "convergence/runs/result_cache.hpp"
#include "convergence/runs/run_spec.hpp"
#include "convergence/system/run_program.hpp"
#include "solver/cache/solve_cache.hpp"

namespace slipstick::convergence {

/// The exit code of a worker whose result, or the fields beside it, could not be written.
inline constexpr int kNotKept = 3;

/// A slipstick program that solves runs one after the other and keeps their results in a folder; all that it
/// makes for one and the next needs too is made once. It ends with this process, see ProgramOptions::tied_by,
/// and by itself over a run that fails. Who leaves it in the middle of a run kills it.
class Worker {
 public:
  /// memory_limit: bytes that one run may take; none: what the machine has left.
  Worker(const std::filesystem::path& program, const std::filesystem::path& folder,
         std::optional<double> memory_limit);

  /// Starts a run; the one before has to be finished. Where the worker is dead, its output says so.
  void start(const RunSpec& run);

  /// The descriptor that is ready when next() is.
  int output() const { return program_.output(); }

  /// What it says next: more is to come, its run is finished and it waits for another, or that it has ended.
  enum class Said { more, finished, ended };
  Said next();

  /// Lets it end, where it has not, when its run is finished.
  void let_end() { program_.end_feed(); }

  /// Waits for its end.
  ProgramEnd wait();

 private:
  Program program_;
};

/// Solves a run, on one thread unless its scene says otherwise, and keeps its result. Throws InputError where
/// a file cannot be written, and as below.
void keep_result_of(PreparedRun run, std::optional<double> memory_limit,
                    const std::shared_ptr<solver::SolveCache>& shared, const ResultCache& cache);

/// What a worker does: solves the runs that come on standard input, and says on standard output when each is
/// finished. Returns its exit code: not 0 where a file cannot be written, and standard error says so. Throws
/// std::runtime_error if memory runs out, OutOfMemory where a solve would take more than `memory_limit`.
int serve_runs(const std::filesystem::path& folder, std::optional<double> memory_limit);

}  // namespace slipstick::convergence
