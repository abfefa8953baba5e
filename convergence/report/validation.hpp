#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "convergence/runs/process_pool.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// How large the validation is.
struct ValidationSize {
  solver::Index loading_cells;            ///< cells along each side for the loading curve and the maps
  std::vector<solver::Index> mesh_cells;  ///< of the mesh study
  std::vector<solver::Index>
      ellipse_cells;  ///< along the ellipse's long axis; half as many along the short one
  std::array<solver::Index, 3> gallery_cells;  ///< along the longer side
  std::vector<double> moment_ratios;           ///< of the loading curve
  solver::Index study_cells;                   ///< the finest mesh of the studies
  std::size_t hard_step;                       ///< 1: all hard cases; 10: every tenth
  bool gates;                                  ///< convergence/gates/quick.toml is run too
};
ValidationSize quick_validation();  ///< seconds: is everything there?
ValidationSize page_validation();   ///< a minute or two
ValidationSize full_validation();   ///< finer meshes

/// A study's meshes, rising, without those that are finer than `most`; this one in their place.
std::vector<solver::Index> up_to(std::vector<solver::Index> cells, solver::Index most);

/// The paper's validation (its Section 5, Figs. 1-5) of its scene, computed and compared with the exact
/// solution, beside it an elliptic contact, where the paper's method fails, the gallery, the studies of the
/// meshes and the tolerances, the hard cases by each method, other programs' fields and the accuracy gates,
/// from the files in `inputs` (scenes/, studies/, hard/, check/fields/, gates/): fills `folder` with
/// report.json and the fields that the page draws, and returns report.json's content. Throws
/// std::runtime_error where a run has no result, and as the pool does.
Json validate(const std::filesystem::path& inputs, const ValidationSize& size,
              const std::filesystem::path& folder, const ProcessPool& pool);

/// What is wrong in the paper's equations as printed, each with numbers as evidence, computed here or taken
/// from the results of the paper's method on a circular and on elliptic contacts.
Json errata(const Json& circle, const Json& ellipses);

/// What the page shows of the exact side alone, no solve needed: for the sphere `curve` (stick radius and
/// twist against moment), `equation_5_digits`, `approximations` (errors of laws in use) and
/// `approximation_table`; for sphere, cone and flat punch `bodies`; `loop` (a history with an inner loop) and
/// `cycle_energy`.
Json exact_curves();

}  // namespace slipstick::convergence
