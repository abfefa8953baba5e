#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "convergence/report/page.hpp"
#include "convergence/results/markup.hpp"
#include "convergence/runs/process_pool.hpp"
#include "solver/grid/grid.hpp"

/// The page of any scene: description, answer, orders of convergence, error against time, hard cases; for the
/// paper's scene also the paper's validation.
namespace slipstick::convergence {

/// How large the validation is.
struct ValidationSize {
  solver::Index loading_cells;            ///< cells along each side for the loading curve and the maps
  std::vector<solver::Index> mesh_cells;  ///< of the mesh study
  std::vector<solver::Index>
      ellipse_cells;                  ///< along the ellipse's long axis; half as many along the short one
  std::vector<double> moment_ratios;  ///< of the loading curve
  std::size_t hard_step;              ///< 1: all hard cases; 10: every tenth
  bool gates;  ///< convergence/gates/quick.toml is run too, and studies of the literature
};
ValidationSize quick_validation();  ///< seconds: is everything there?
ValidationSize page_validation();   ///< a minute or two
ValidationSize full_validation();   ///< finer meshes

/// inputs: the folder with scenes/, hard/, check/fields/, gates/ and literature/.
struct Validation {
  std::filesystem::path inputs;
  ValidationSize size;
};

/// Section 5 of the paper (Figs. 1-5) for its scene against the exact solution; an elliptic contact, where
/// the paper's method fails; other laws of friction; the hard cases by each method; fields of other programs;
/// published numbers; the accuracy gates. Writes the fields that the page draws into `folder`. Throws
/// std::runtime_error where a run has no result, and as the pool does.
PaperValidation validate(const Validation& request, const std::filesystem::path& folder,
                         const ProcessPool& pool);

/// The size of a page.
struct PageSize {
  solver::Index most_cells;  ///< along the longer side of the answer's mesh; a scene with fewer keeps its own
  /// Bound of the study's finest mesh, which else has twice the answer's cells.
  solver::Index most_study_cells;
  int shifts;                          ///< grids of each mesh, see Study; two for a history
  solver::Index method_cells;          ///< the finest mesh on which methods are compared
  std::vector<double> operator_cells;  ///< meshes for direct sums against convolution
  int repetitions;                     ///< of each of these times
  bool finer_meshes;                   ///< hard variants are also solved on finer meshes
  std::size_t long_history;            ///< a history with more steps has half as fine meshes
};
PageSize quick_page();
PageSize usual_page();
PageSize full_page();
/// The same for another program, which may take a hundred times as long.
PageSize for_program(PageSize size);

/// The largest relative error that the user accepts for a number of the result.
struct WantedError {
  std::string quantity;  ///< key of a number of the result, twist_angle; "twist" is short for it
  double error;
};
/// "twist=1e-3". Throws InputError for anything else, and for an error that is not between 0 and 1.
WantedError read_wanted_error(const std::string& word);

/// The input of a page.
struct PageRequest {
  RunSpec base;  ///< the scene; overrides may name a program that solves it
  PageSize size;
  std::vector<WantedError> wanted = {};
  std::vector<std::string> uncertain = {};    ///< as uncertain_inputs() takes them
  std::vector<BesideMethod> beside = {};      ///< programs to compare with
  std::optional<Validation> validation = {};  ///< of the paper, for the page of its scene
};

/// Solves all that the page shows and judges it, then writes report.json and answer.h5 (the fields on the
/// finest mesh) to the folder.
///   1. The answer on its meshes; studies of meshes and tolerances; each number with its error.
///   2. Error against time; equivalent scenes, coarse meshes and extreme loads; digits left by rounding.
///   3. The paper's validation, if it is requested.
///   4. The headline: findings and changes since the page that was in the folder.
/// Throws InputError for a scene that cannot be read and for a quantity of `wanted` that the result does not
/// have; std::runtime_error where the scene itself has no answer, and as the pool does.
Page scene_page(const PageRequest& request, const std::filesystem::path& folder, const ProcessPool& pool);

/// A case for each finding.
std::vector<JunitCase> page_cases(const Page& page);

}  // namespace slipstick::convergence
