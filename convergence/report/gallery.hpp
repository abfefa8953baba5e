#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "convergence/results/result_parts.hpp"
#include "convergence/runs/run_spec.hpp"

namespace slipstick::convergence {

/// The number that a scene is judged by, at the end of its last step; in results under `key`.
struct GalleryQuantity {
  std::string name;
  std::string key;
  std::string unit;  ///< empty: a ratio
};

struct GalleryScene {
  std::string stem;  ///< of its scene file
  std::string title;
  std::string shows;  ///< one sentence
  GalleryQuantity quantity;
  /// A height map or a random surface: finer meshes see more of it, so their values follow no power of
  /// the cell size and nothing is extrapolated.
  bool rough = false;
};

/// The scenes that show what can be solved.
const std::vector<GalleryScene>& gallery_scenes();

/// The runs of a scene from a folder on three meshes with `across` cells along the longer side, coarsest
/// first (of a height map at its own size alone); the last writes its contact cells into the folder `fields`.
std::vector<RunSpec> gallery_runs(const GalleryScene& scene, const std::filesystem::path& scenes,
                                  const std::array<solver::Index, 3>& across,
                                  const std::filesystem::path& fields);

/// What a scene shows, from the results of its runs: the judged quantity at the finest mesh with its exact or
/// extrapolated value, the certificate's worst gap, the work, and the name of the file of contact cells.
Json gallery_row(const GalleryScene& scene, const std::vector<Json>& meshes);

}  // namespace slipstick::convergence
