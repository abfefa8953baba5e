#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "convergence/exchange/solver_program.hpp"
#include "convergence/results/solve_record.hpp"
#include "convergence/runs/progress.hpp"
#include "convergence/runs/run_spec.hpp"

namespace slipstick::convergence {

struct ProcessPoolOptions {
  std::filesystem::path folder;  ///< keeps finished results, see ResultCache
  int jobs = 0;                  ///< processes at a time; 0: one for each processor
  /// Bytes that all processes together may take; none: most of the memory that is free.
  std::optional<double> memory_limit = {};
  std::filesystem::path program = {};  ///< the slipstick program, which solves
  /// Called at least once a second, and after each signal: whether to stop. Null: never.
  bool (*interrupted)() = nullptr;
  AllowedPrograms programs = {};  ///< that scenes may name
  /// Null: runs without a result are solved. Otherwise they are added here, none is solved, and their records
  /// are refused.
  std::vector<PreparedRun>* lacking = nullptr;
  std::shared_ptr<Progress> progress = std::make_shared<Progress>();  ///< is printed
};

/// Solves many scenes side by side, each in a slipstick process, as many at a time as processors and memory
/// allow; every command that solves several scenes uses it. Finished results are kept on disk and not
/// computed again by the same program, so that an interrupt or a killed process loses the unfinished solves
/// only. The processes end with this one (see ProgramOptions::tied_by); signal handlers and other child
/// processes are not touched. Progress is printed on standard error.
class ProcessPool {
 public:
  explicit ProcessPool(ProcessPoolOptions options);

  /// The records in the order of the runs; equal runs are computed once. Gross slip or too little memory
  /// gives a record with the status refused, a process that was killed or failed one with the status failed;
  /// both have a message and the run's name. A run refused for its memory has out_of_memory, and is not kept
  /// on disk. Throws InputError, before anything is computed, for a scene that cannot be read, one that names
  /// a program which may not run, and a folder that cannot be made; std::runtime_error after an interrupt,
  /// and where a result or its fields cannot be written, since all later ones would be lost too.
  std::vector<SolveRecord> run(const std::vector<RunSpec>& specs) const;
  std::vector<SolveRecord> run_prepared(const std::vector<PreparedRun>& runs) const;

  /// The same; a scene that cannot be read gives a record with the status refused.
  std::vector<SolveRecord> run_or_refuse(const std::vector<RunSpec>& specs) const;

  /// Number of runs that were listed instead of being solved.
  std::size_t lacking() const { return options_.lacking == nullptr ? 0 : options_.lacking->size(); }
  Progress& progress() const { return *options_.progress; }
  std::optional<double> memory_limit() const { return options_.memory_limit; }
  const std::filesystem::path& folder() const { return options_.folder; }

 private:
  /// The runs with the versions of their programs.
  std::vector<PreparedRun> with_versions(const std::vector<PreparedRun>& runs) const;

  ProcessPoolOptions options_;
};

}  // namespace slipstick::convergence
