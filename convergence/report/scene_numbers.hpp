#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "convergence/report/scene_page.hpp"
#include "convergence/results/result_parts.hpp"
#include "solver/scene/scene.hpp"

/// What a page says of its scene: what it is, and its numbers with how far each may be off.
namespace slipstick::convergence {

/// What a scene is: {name, text, summary: [[words, value]], gap: {x1, along_1, x2, along_2}}, the gap in m
/// along both axes of the grid through its centre; null where the bodies cannot touch.
/// on_page: the scene with the cells that the page's answer has.
Json describe(const solver::Scene& scene, const solver::Scene& on_page, const std::filesystem::path& file);

/// The coarsest mesh of a study, cells along the longer side.
inline constexpr solver::Index kFewestCells = 8;

/// The meshes on which a scene is solved, cells along the longer side, rising; none where it has its own.
struct Meshes {
  bool given;
  std::vector<solver::Index> study;
  std::vector<solver::Index> answer;
};
Meshes meshes_of(const solver::Scene& scene, const PageSize& size);

/// The results on the answer's meshes, coarsest first; the last one has its fields in a file. Throws
/// std::runtime_error where that has no answer.
std::vector<Json> solve_answer(const RunSpec& base, const solver::Scene& scene, const Meshes& meshes,
                               const std::filesystem::path& fields, const ProcessPool& pool);

/// The studies of meshes, unless the scene has its own, and of tolerances.
Json scene_studies(const RunSpec& base, const solver::Scene& scene, const Meshes& meshes,
                   const PageSize& size, const ProcessPool& pool);

/// A row for each number that the answer has, with its error: what the mesh and the length of the steps leave
/// open, or null where one of them is not known. study: of meshes.
Json number_rows(const solver::Scene& scene, const std::vector<Json>& results, const Json& study);

/// The name of a number of a page in words.
std::string words_of(const std::string& number);

/// The number by which answers are compared, and what it is compared with.
struct Reference {
  std::string number;  ///< key in a result: twist_angle, displacement, moment, ...
  double value;        ///< its size, SI units; NaN: nothing is known
  double uncertainty;  ///< relative, with that of the steps' length; 0: exact
};

/// That of the number which the result's uncertainty is of, or of the first of some that has one.
Reference reference_of(const Json& answer, const Json& rows);

}  // namespace slipstick::convergence
