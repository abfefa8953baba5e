#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "convergence/results/result_parts.hpp"
#include "convergence/runs/run_spec.hpp"

namespace slipstick::convergence {

/// The stand-in for the result of a run that has none; see ProcessPool::run().
Json not_computed(const std::string& status, const std::string& message, const RunSpec& spec);

/// Whether a run has no result: its process died, or what it was asked for cannot be had.
bool is_failed(const Json& result);

bool is_converged(const Json& result);

/// Why a result lacks a number, or has none at its path; empty: it has it.
std::string why_missing(const Json& result, const std::string& path);

/// How many of some runs have no result, and what the first of them says.
class FailedRuns {
 public:
  /// name: of the run; a run that comes again under its name counts once.
  void add(const std::string& name, const Json& result);

  /// {count, of, first: {run, message}}; first is missing where none failed.
  Json json() const;

 private:
  std::map<std::string, bool> runs_;  ///< whether it failed, once or more
  Json first_;
};

/// A sentence on the failed runs of a result: "1 of 35 runs failed; the first (paper, grid.cells=[96,96]):
/// its process was killed by signal 9"; empty where none did, or none are counted.
std::string failed_runs_text(const Json& result);

}  // namespace slipstick::convergence
