#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "convergence/results/result_parts.hpp"
#include "solver/grid/ranks.hpp"

namespace CLI {
class App;
}

namespace slipstick::convergence {

/// What `solve` is asked for, as its options say it.
struct SolveRequest {
  std::string scene;                   ///< file
  std::vector<std::string> overrides;  ///< "key=value"
  bool allow_programs = false;
  std::string fields;  ///< file; empty: none, as of the other files
  std::string figure;
  std::string model;               ///< word of solver.model; empty: the scene's
  std::optional<double> accuracy;  ///< relative error to reach
  std::string accuracy_of = "twist";
  std::vector<std::string> uncertain;  ///< "key=P%"
  bool plan = false;
  int planned_ranks = 1;         ///< of the plan
  solver::Ranks processes = {};  ///< that share the solve
  std::string checkpoint;
  bool resume = false;
  std::optional<std::uint64_t> memory_limit;  ///< bytes
  std::string keep;                           ///< folder for the results of a pool's worker; empty: none
};

/// Does it: writes what a person reads to the stream, fills the result, and returns the exit code. command:
/// its options name the files that are written. Throws InputError.
int run_solve(const CLI::App& command, const SolveRequest& request, std::ostream& text, Json& result);

}  // namespace slipstick::convergence
