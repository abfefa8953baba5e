#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "convergence/exchange/allowed_programs.hpp"
#include "convergence/results/result_parts.hpp"
#include "convergence/runs/run_spec.hpp"
#include "convergence/system/run_program.hpp"

namespace slipstick::convergence {

struct ProcessPoolOptions {
  std::filesystem::path folder;  ///< keeps finished results, see ResultCache
  int jobs = 0;                  ///< processes at a time; 0: one a processor
  /// Bytes that all processes together may take; none: most of what the machine has left.
  std::optional<double> memory_limit = {};
  std::filesystem::path program = {};  ///< the slipstick program, which solves
  /// Other folders of finished results: what is found there is not solved, but kept in `folder` too.
  std::vector<std::filesystem::path> joined = {};
  /// Asked every second at least, and when a signal ends waiting: whether to stop.
  std::function<bool()> interrupted = {};
  AllowedPrograms programs = {};  ///< that scenes may name
};

/// The one way in which many scenes are solved: side by side, each by a slipstick program of its own, as many
/// at a time as there are processors and memory allows. Finished results are kept on disk and never computed
/// again by the same program; an interrupt or a killed process loses at most what is being computed. The
/// processes end with this one (see ProgramOptions::tied_by); its other children are left alone, and its
/// handlers of signals. Says on standard error how far it is.
class ProcessPool {
 public:
  explicit ProcessPool(ProcessPoolOptions options);

  /// The results, in the order of the runs; equal runs are computed once. What a scene asks for and cannot
  /// have, gross slip or memory for one, is a result with status = "refused"; one whose process was killed or
  /// failed has status = "failed"; both have a message and `run`, which says which it was. One that would
  /// take more memory than it may has out_of_memory = true beside it, and is not kept. Throws InputError,
  /// before anything is computed, for a scene that cannot be read, one that names a program which is not
  /// allowed to run, and a folder that cannot be made; std::runtime_error where it was interrupted, or a
  /// result or its fields could not be written: then the rest would be in vain.
  std::vector<Json> run(const std::vector<RunSpec>& specs) const;
  std::vector<Json> run_prepared(const std::vector<PreparedRun>& runs) const;

  /// The same for one.
  Json run(const RunSpec& spec) const;

  /// Those of the runs whose result is neither in the folder nor in one that it joins.
  std::vector<PreparedRun> missing(const std::vector<PreparedRun>& runs) const;

  std::optional<double> memory_limit() const { return options_.memory_limit; }
  const std::filesystem::path& folder() const { return options_.folder; }

 private:
  /// The runs with the versions of their programs.
  std::vector<PreparedRun> with_versions(const std::vector<PreparedRun>& runs) const;

  ProcessPoolOptions options_;
};

}  // namespace slipstick::convergence
