#pragma once

#include <filesystem>
#include <vector>

#include "convergence/runs/process_pool.hpp"
#include "solver/grid/grid.hpp"

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

/// The files that the validation reads (scenes/, hard/, check/fields/, gates/, literature/ in a folder), and
/// its size.
struct Validation {
  std::filesystem::path inputs;
  ValidationSize size;
};

/// Is the paper right? Its Section 5 (Figs. 1-5) for its scene, computed and compared with the exact
/// solution; beside it an elliptic contact, where the paper's method fails, the hard cases by each method,
/// fields of other programs and the accuracy gates. Writes the fields that the page draws into `folder`.
/// Throws std::runtime_error where a run has no result, and as the pool does.
Json validate(const Validation& asked, const std::filesystem::path& folder, const ProcessPool& pool);

/// What is wrong in the paper's equations as printed, each with numbers as evidence, computed here or taken
/// from the results of the paper's method on a circular and on elliptic contacts.
Json errata(const Json& circle, const Json& ellipses);

/// What the page shows of the exact side alone, no solve needed: for the sphere `curve` (stick radius and
/// twist against moment), `equation_5_digits`, `approximations` (errors of laws in use) and
/// `approximation_table`; for sphere, cone and flat punch `bodies`; `loop` (a history with an inner loop) and
/// `cycle_energy`.
Json exact_curves();

}  // namespace slipstick::convergence
