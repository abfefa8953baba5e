#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "convergence/results/result_parts.hpp"
#include "convergence/runs/runner.hpp"

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
  /// Of a height map, or of a random surface: finer meshes see more of it, so their values follow no power of
  /// the cell size and nothing is extrapolated.
  bool rough = false;
};

/// The scenes that show what can be solved.
const std::vector<GalleryScene>& gallery_scenes();

/// How many solves gallery() makes at most.
std::size_t gallery_solves();

/// Solves a scene from a folder at three meshes with so many cells along the longer side, coarsest first (a
/// height map at its own size alone), and returns what it shows, the judged quantity at the finest mesh with
/// its exact or extrapolated value, the certificate's worst gap, the work, and the name of the file in
/// `fields` with the contact cells of the last step.
Json gallery_row(Runner& runner, const GalleryScene& scene, const std::filesystem::path& scenes,
                 const std::array<solver::Index, 3>& across, const std::filesystem::path& fields);

/// The rows of all scenes.
Json gallery(Runner& runner, const std::filesystem::path& scenes, const std::array<solver::Index, 3>& across,
             const std::filesystem::path& fields);

}  // namespace slipstick::convergence
