#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "convergence/studies/study.hpp"

/// The meshes of a study, and what is found on them.
namespace slipstick::convergence {

/// One grid of a mesh.
struct GridChoice {
  std::vector<std::string> overrides;
  std::array<solver::Index, 2> cells;
  double size;  ///< m, the side of a square of a cell's area
};

struct Mesh {
  std::vector<GridChoice> grids;
  bool rounded = false;  ///< rounding is looked at here
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

/// The results on one mesh, to the series' tolerance.
struct MeshResults {
  std::vector<Json> grids;
  Json tightened;             ///< the first grid's
  std::vector<Json> rounded;  ///< likewise
};

/// All combinations of the varied values, with their meshes. Throws InputError for a scene that cannot have
/// them, OutOfMemory for one that would take more than `memory_limit`.
std::vector<Series> make_series(const Study& study, std::optional<double> memory_limit = {});

RunSpec make_run(const Study& study, const GridChoice& grid, double tolerance);

// ---------------------------------------------------------------- what its results say (study_judgement.cpp)

/// Orders, extrapolated values and budgets of a series, with the rows that they are determined from.
Json judge_series(const Study& study, const Series& series, const std::vector<MeshResults>& results);

/// Whether an order that is fitted would say more about the tolerance than about the mesh.
bool needs_tightening(const Study& study, const Series& series, const std::vector<MeshResults>& results);

/// The tolerances asked for, each on every mesh, and what stopping there added. by_mesh: results to each
/// tolerance, and to one that stands for none; results: those that judge_series() has.
Json tolerance_rows(const Study& study, const Series& series, const std::vector<std::vector<Json>>& by_mesh,
                    const std::vector<MeshResults>& results);

}  // namespace slipstick::convergence
