#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/work/work_counts.hpp"

namespace slipstick::bench {

/// The work that a solve reports; zeros for a case that is no solve.
struct SolveWork {
  double applications =
      0.0;  ///< of the tangential operator, all grids converted to applications on the finest
  double pressure_applications = 0.0;  ///< of the normal operator, converted in the same way
  int iterations = 0;
};

/// A piece of work whose counts are known.
struct WorkCase {
  std::string name;
  /// Reads and makes what is not counted, and returns what is.
  std::function<std::function<SolveWork()>()> prepare;
};

/// Scenes on one thread that take less than a second, and parts of a solve.
std::vector<WorkCase> work_cases();

struct CaseCounts {
  SolveWork solve;
  WorkCounts counts;
};

/// Does it once before, so that what is made at first use and kept is not counted. Throws std::runtime_error
/// for a solve that did not converge.
CaseCounts count_work(const WorkCase& work_case);

}  // namespace slipstick::bench
