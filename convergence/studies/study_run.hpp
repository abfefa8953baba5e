#pragma once

#include <optional>
#include <vector>

#include "convergence/runs/process_pool.hpp"
#include "convergence/studies/study.hpp"
#include "convergence/studies/study_result.hpp"

namespace slipstick::convergence {

/// The runs of a study that do not depend on results. Runs to tighter tolerances follow where the iteration
/// error shows in the results. Throws as make_series().
std::vector<PreparedRun> study_runs(const Study& study, std::optional<double> memory_limit = {});

/// 1. Makes the series and their meshes; 2. solves them, again to tighter tolerances where the iteration
/// error is a tenth of the discretisation error; 3. fits and judges each quantity of each series; 4. solves
/// to the tolerances that the study varies.
StudyResult run_study(const Study& study, const ProcessPool& pool);

}  // namespace slipstick::convergence
