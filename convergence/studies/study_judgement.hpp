#pragma once

#include <vector>

#include "convergence/studies/study_plan.hpp"

/// The judgement of a study by its results.
namespace slipstick::convergence {

/// Orders, extrapolated values and budgets of a series, with the rows that they are determined from.
Json judge_series(const Study& study, const Series& series, const std::vector<MeshResults>& results);

/// Whether an order that is fitted would say more about the tolerance than about the mesh.
bool needs_tightening(const Study& study, const Series& series, const std::vector<MeshResults>& results);

/// The tolerances asked for, each on every mesh, and what stopping there added. by_mesh: results to each
/// tolerance, and to one that stands for none; results: those that judge_series() has.
Json tolerance_rows(const Study& study, const Series& series, const std::vector<std::vector<Json>>& by_mesh,
                    const std::vector<MeshResults>& results);

}  // namespace slipstick::convergence
