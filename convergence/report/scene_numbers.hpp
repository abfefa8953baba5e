#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "convergence/report/page.hpp"
#include "convergence/results/result_parts.hpp"
#include "convergence/runs/process_pool.hpp"
#include "convergence/studies/study_result.hpp"
#include "solver/scene/scene.hpp"

/// The numbers of a page, with the meshes and studies from which their errors follow.
namespace slipstick::convergence {

/// The size of a page of another program, which may take a hundred times as long.
PageSize for_program(PageSize size);

/// The meshes on which a scene is solved, cells along the longer side, rising; empty where the files of the
/// scene give its grid.
struct Meshes {
  bool given;
  std::vector<solver::Index> study;
  std::vector<solver::Index> answer;
};
Meshes meshes_of(const solver::Scene& scene, const PageSize& size);

/// A scene of a page with all that its solves need.
struct PageScene {
  RunSpec base;  ///< the scene as the user names it
  solver::Scene scene;
  PageSize size;
  Meshes meshes = {};
  bool own = true;         ///< this program solves it, no other one
  bool shortened = false;  ///< a long history: its meshes are half as fine

  /// The scene on another mesh, on the answer's coarsest one, and on its finest one. Where the files of the
  /// scene give its grid, the last two are the scene itself.
  RunSpec on(solver::Index cells) const;
  RunSpec on_coarsest() const { return meshes.given ? base : on(meshes.answer.front()); }
  RunSpec on_finest() const { return meshes.given ? base : on(meshes.answer.back()); }
};

/// Reads the scene, and chooses its meshes: coarser ones for another program and for a long history. Throws
/// InputError for a scene that cannot be read.
PageScene page_scene(const RunSpec& base, const PageSize& size);

/// The results on the answer's meshes, coarsest first; the fields of the last one are written to a file.
/// Throws std::runtime_error where it has no answer.
std::vector<Json> solve_answer(const PageScene& at, const std::filesystem::path& fields, const ProcessPool& pool);

/// The studies of meshes, unless the scene has its own, and of tolerances.
std::vector<StudyResult> scene_studies(const PageScene& at, const ProcessPool& pool);

/// Each number of the answer with its error, by the mesh and by the length of the load steps. results:
/// coarsest mesh first; study: of meshes.
std::vector<PageNumber> number_rows(const solver::Scene& scene, const std::vector<Json>& results,
                                    const StudyResult& study);

/// The row of a number; nullptr where there is none.
const PageNumber* find_row(const std::vector<PageNumber>& rows, const std::string& key);

/// The name of a number in words.
std::string words_of(const std::string& number);

/// The number by which answers are compared, and its reference value.
struct Reference {
  std::string number;  ///< key in a result: twist_angle, displacement, moment, ...
  double value;        ///< its size, SI units; NaN: unknown
  double uncertainty;  ///< relative, including the length of the steps; 0: exact
};

/// The number to which the uncertainty of the result refers, else the first of some that has an error.
Reference reference_of(const Json& answer, const std::vector<PageNumber>& rows);

}  // namespace slipstick::convergence
