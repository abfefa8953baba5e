#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "convergence/report/page.hpp"
#include "convergence/report/scene_page.hpp"
#include "convergence/results/result_parts.hpp"
#include "convergence/studies/study_result.hpp"
#include "solver/scene/scene.hpp"

/// The numbers of a page, with the meshes and studies from which their errors follow.
namespace slipstick::convergence {

/// The coarsest mesh of a study, cells along the longer side.
inline constexpr solver::Index kFewestCells = 8;

/// The meshes on which a scene is solved, cells along the longer side, rising; empty where the files of the
/// scene give its grid.
struct Meshes {
  bool given;
  std::vector<solver::Index> study;
  std::vector<solver::Index> answer;
};
Meshes meshes_of(const solver::Scene& scene, const PageSize& size);

/// The results on the answer's meshes, coarsest first; the fields of the last one are written to a file.
/// Throws std::runtime_error where it has no answer.
std::vector<Json> solve_answer(const RunSpec& base, const solver::Scene& scene, const Meshes& meshes,
                               const std::filesystem::path& fields, const ProcessPool& pool);

/// The studies of meshes, unless the scene has its own, and of tolerances.
std::vector<StudyResult> scene_studies(const RunSpec& base, const solver::Scene& scene, const Meshes& meshes,
                                       const PageSize& size, const ProcessPool& pool);

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
