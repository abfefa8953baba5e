#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "convergence/results/result_parts.hpp"
#include "convergence/results/solve_record.hpp"
#include "convergence/runs/run_spec.hpp"

namespace slipstick::convergence {

/// The record of a run without an answer; status: refused or failed.
SolveRecord not_computed(RunStatus status, const std::string& message, const RunSpec& spec);

/// Counts the runs without an answer, and keeps the message of the first.
class FailedRuns {
 public:
  /// name: of the run; equal names count once.
  void add(const std::string& name, const SolveRecord& record);
  void add(const std::string& name, const Json& result);

  /// {count, of, first: {run, message}}; first is missing where none failed.
  Json json() const;

  /// "1 of 35 runs failed; the first (paper, grid.cells=[96,96]): its process was killed by signal 9"; empty
  /// where none failed.
  std::string text() const;

  std::size_t count() const;

 private:
  struct First {
    std::string run;
    std::string message;
  };

  std::map<std::string, bool> runs_;  ///< whether it failed, once or more
  std::optional<First> first_;
};

/// The same of a result's key failed_runs.
std::string failed_runs_text(const Json& result);

// The same for results as JSON; to be removed once all callers take records.
bool is_failed(const Json& result);
bool is_converged(const Json& result);
std::string why_missing(const Json& result, const std::string& path);

}  // namespace slipstick::convergence
