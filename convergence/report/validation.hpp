#pragma once

#include <filesystem>
#include <vector>

#include "convergence/report/page.hpp"
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

}  // namespace slipstick::convergence
