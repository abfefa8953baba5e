#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "convergence/results/result_parts.hpp"
#include "convergence/runs/process_pool.hpp"
#include "convergence/runs/run_spec.hpp"
#include "convergence/studies/study.hpp"
#include "convergence/studies/study_result.hpp"

/// The meshes and the runs of a study.
namespace slipstick::convergence {

/// One grid of a mesh.
struct GridChoice {
  std::vector<std::string> overrides;
  std::array<solver::Index, 2> cells;
  double size;  ///< m, the side of a square of a cell's area
};

struct Mesh {
  std::vector<GridChoice> grids;
  bool rounded = false;  ///< the first grid is also solved with directed rounding
};

/// One combination of the varied values.
struct Series {
  std::string name;
  Json set = Json::object();
  std::vector<std::string> overrides;
  std::vector<Mesh> meshes;
  double tolerance = 0.0;
  int tightenings = 0;
};

/// All combinations of the varied values, with their meshes. Throws InputError for a scene that cannot have
/// these meshes, OutOfMemory for a scene that needs more than `memory_limit`.
std::vector<Series> make_series(const Study& study, std::optional<double> memory_limit = {});

RunSpec make_run(const Study& study, const GridChoice& grid, double tolerance);

/// 1. Makes the series and their meshes; 2. solves them, again to tighter tolerances where the iteration
/// error is a tenth of the discretisation error; 3. fits and judges each quantity of each series; 4. solves
/// to the tolerances that the study varies. A pool that lists runs gets the runs of 2 and 4, and nothing
/// is judged unless all have results. Throws as make_series().
StudyResult run_study(const Study& study, const ProcessPool& pool);

}  // namespace slipstick::convergence
