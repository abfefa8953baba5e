#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include "convergence/results/solve_record.hpp"
#include "convergence/runs/run_spec.hpp"
#include "convergence/runs/solve_scene.hpp"

namespace slipstick::convergence {

/// The state of a history on disk (HDF5), from which a killed history resumes after its last finished step. A
/// file is valid for the same scene, options, input files and executable, so that a resumed history has the
/// digits of an uninterrupted one.
class Checkpoint {
 public:
  Checkpoint(std::filesystem::path file, const PreparedRun& run);

  /// The content of the file; null: there is no file. Throws InputError for a file of another scene or
  /// executable and for a damaged file.
  std::shared_ptr<const FinishedSteps> read() const;

  /// Writes after the first step, then whenever writing takes at most 1 % of the time since the last. Replaces the
  /// file in one step, so that a complete file is always on disk. Throws InputError if that fails.
  void offer(const solver::HistoryState& state, const std::vector<StepRecord>& steps);

 private:
  using Clock = std::chrono::steady_clock;

  void write(const solver::HistoryState& state, const std::vector<StepRecord>& steps) const;

  std::filesystem::path file_;
  std::string scene_;       ///< identifies what is solved
  std::string program_;     ///< identifies the executable
  Clock::duration took_{};  ///< to write the last checkpoint
  Clock::time_point written_{};
};

}  // namespace slipstick::convergence
