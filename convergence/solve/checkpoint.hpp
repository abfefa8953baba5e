#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include "convergence/results/solve_record.hpp"
#include "convergence/runs/run_spec.hpp"
#include "convergence/runs/solve_scene.hpp"

namespace slipstick::convergence {

/// Where a history stands, on disk (HDF5), so that one that was killed goes on after a finished step. A file
/// counts for the same scene, options and inputs, and the same program: only then the digits are those of a
/// history that was not interrupted.
class Checkpoint {
 public:
  Checkpoint(std::filesystem::path file, const PreparedRun& run);

  const std::filesystem::path& file() const { return file_; }

  /// The content of the file; null where there is none. Throws InputError for a file of another scene or
  /// program, and one that is damaged.
  std::shared_ptr<const FinishedSteps> read() const;

  /// Replaces the file by one that holds this, whole on the disk. Throws InputError where it cannot.
  void write(const solver::HistoryState& state, const std::vector<StepRecord>& steps) const;

 private:
  std::filesystem::path file_;
  std::string scene_;    ///< identifies what is solved
  std::string program_;  ///< identifies the executable
};

/// Writes a checkpoint after the first step, and then whenever writing takes little of the time that went by.
class PacedCheckpoint {
 public:
  explicit PacedCheckpoint(const Checkpoint& checkpoint) : checkpoint_(checkpoint) {}
  void offer(const solver::HistoryState& state, const std::vector<StepRecord>& steps);

 private:
  using Clock = std::chrono::steady_clock;

  const Checkpoint& checkpoint_;
  Clock::duration took_{};  ///< the last one
  Clock::time_point written_{};
};

}  // namespace slipstick::convergence
