#pragma once

#include <string>
#include <vector>

#include "convergence/results/result_parts.hpp"
#include "convergence/runs/process_pool.hpp"
#include "convergence/studies/study_result.hpp"
#include "convergence/studies/study_run.hpp"

namespace slipstick::convergence {

/// The parts of the error of one result: observed = discretisation + iteration. rounding and reference are
/// bounds of the error of `discretisation`.
struct Budget {
  double observed = 0.0;        ///< signed
  double discretisation = 0.0;  ///< signed: error of the converged iteration
  double iteration = 0.0;       ///< signed: error by stopping at the tolerance
  double rounding = 0.0;        ///< change under directed rounding
  double reference = 0.0;       ///< uncertainty of the exact answer
};

/// Ratio of the tolerances of a tightened and an observed run. The iteration error of the tightened one is a
/// hundredth of the observed one's, or a tenth where the error is proportional to the root of the tolerance.
inline constexpr double kTightening = 1e-2;

/// The run to a hundredth of its tolerance, then this one rounded upward and downward.
std::vector<RunSpec> budget_runs(const RunSpec& observed, double tolerance);

/// The parts of an error, a path into the results. A part is NaN if a result for it has no number.
Budget split_error(const std::string& quantity, const Json& observed, const Json& tightened,
                   const std::vector<Json>& rounded);

/// Solves all runs and splits the error.
Budget error_budget(const PreparedRun& run, const std::string& quantity, const ProcessPool& pool);

/// The name of the largest part.
std::string largest_part(const Budget& budget);

/// The results on one mesh, to the tolerance of its series.
struct MeshResults {
  std::vector<Json> grids;
  Json tightened;             ///< of the first grid, to a hundredth of the tolerance
  std::vector<Json> rounded;  ///< of the first grid, to that tolerance, rounded upward and downward
};

/// Orders, limits and budgets of a series.
///   1. Chooses the quantities: from the study file, or all errors that the result has, and the values that
///      the exact answer does not have.
///   2. Takes mean and spread of each quantity on each mesh, and the budget of its error.
///   3. Fits the order; of values also the limit, and continues with their distances from it.
SeriesResult judge_series(const Study& study, const Series& series, const std::vector<MeshResults>& results);

/// Whether the iteration error would spoil a fitted order.
bool needs_tightening(const Study& study, const Series& series, const std::vector<MeshResults>& results);

/// A row for each mesh and each tolerance of the study, with the error by stopping there. by_mesh: the results to these
/// tolerances, then the result to the tightest tolerance, which stands in for the converged one.
std::vector<StudyRow> tolerance_rows(const Study& study, const Series& series,
                                     const std::vector<std::vector<Json>>& by_mesh,
                                     const std::vector<MeshResults>& results);

}  // namespace slipstick::convergence
