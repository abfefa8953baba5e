#pragma once

#include <vector>

#include "convergence/results/result_parts.hpp"
#include "convergence/studies/study_plan.hpp"
#include "convergence/studies/study_result.hpp"

namespace slipstick::convergence {

/// The results on one mesh, to the tolerance of its series.
struct MeshResults {
  std::vector<Json> grids;
  Json tightened;             ///< of the first grid, to a hundredth of the tolerance
  std::vector<Json> rounded;  ///< of the first grid, to that tolerance, rounded upward and downward
};

/// Orders, limits and budgets of a series.
///   1. Chooses the quantities: from the study file, or all errors that the result has, and the values that
///   the
///      exact answer does not have.
///   2. Takes mean and spread of each quantity on each mesh, and the budget of its error.
///   3. Fits the order; of values also the limit, and continues with their distances from it.
SeriesResult judge_series(const Study& study, const Series& series, const std::vector<MeshResults>& results);

/// Whether the iteration error would spoil a fitted order.
bool needs_tightening(const Study& study, const Series& series, const std::vector<MeshResults>& results);

/// A row for each mesh and each tolerance of the study, with the error by stopping there. by_mesh: the
/// results to these tolerances, then the result to the tightest tolerance, which stands in for the converged
/// one.
std::vector<StudyRow> tolerance_rows(const Study& study, const Series& series,
                                     const std::vector<std::vector<Json>>& by_mesh,
                                     const std::vector<MeshResults>& results);

}  // namespace slipstick::convergence
