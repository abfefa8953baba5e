#pragma once

#include <array>
#include <string>
#include <vector>

#include "convergence/runs/process_pool.hpp"

namespace slipstick::convergence {

/// The parts of the error of one result. observed = discretisation + iteration; only the sizes of rounding
/// and reference are known, and the discretisation may be off by as much.
struct Budget {
  double observed = 0.0;        ///< signed
  double discretisation = 0.0;  ///< signed: what is left of it when the iteration goes on
  double iteration = 0.0;       ///< signed: what stopping at the tolerance added
  double rounding = 0.0;        ///< change under directed rounding
  double reference = 0.0;       ///< uncertainty of the exact answer
};

/// A run with those that show the parts of its error: to a hundredth of its tolerance, and this rounded
/// upward and downward.
struct BudgetRuns {
  RunSpec observed;
  RunSpec tightened;
  std::array<RunSpec, 2> rounded;
};

/// How much tighter the tolerance is with which a result is compared to see its iteration error. What that
/// leaves is a hundredth of it or a tenth, as the error goes with the tolerance or with its root.
inline constexpr double kTightening = 1e-2;

BudgetRuns budget_runs(const RunSpec& observed, double tolerance);

/// The parts of an error, a path into the results; NaN where a result does not have it, and the rounding
/// where any of the rounded results has none, or there is no such result.
Budget split_error(const std::string& quantity, const Json& observed, const Json& tightened,
                   const std::vector<Json>& rounded);

/// Solves what it takes and splits.
Budget error_budget(const PreparedRun& run, const std::string& quantity, const ProcessPool& pool);

/// The name of the largest part.
std::string largest_part(const Budget& budget);

}  // namespace slipstick::convergence
