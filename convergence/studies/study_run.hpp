#pragma once

#include "convergence/runs/process_pool.hpp"
#include "convergence/studies/study.hpp"
#include "convergence/studies/study_result.hpp"

namespace slipstick::convergence {

/// 1. Makes the series and their meshes; 2. solves them, again to tighter tolerances where the iteration
/// error is a tenth of the discretisation error; 3. fits and judges each quantity of each series; 4. solves
/// to the tolerances that the study varies. A pool that lists runs gets those of 2 and 4, and nothing is
/// judged unless all have results. Throws as make_series().
StudyResult run_study(const Study& study, const ProcessPool& pool);

}  // namespace slipstick::convergence
