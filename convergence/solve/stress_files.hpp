#pragma once

#include <string>
#include <vector>

#include "convergence/results/result_parts.hpp"
#include "solver/scene/scene.hpp"
#include "solver/solution.hpp"

namespace slipstick::convergence {

/// Files that get the stresses below the surface, one for each depth.
struct StressFiles {
  std::string file;                      ///< its name holds "{depth}" where there are several; empty: none
  std::vector<std::string> depth_words;  ///< as --depths takes them: in m, or with a unit
  std::vector<double> depths = {};       ///< m, by read_depths()

  std::string name(std::size_t depth) const;  ///< of the file of depths[depth]
  /// Throws InputError for a depth that is not above zero, and for a scene whose stresses are not known.
  void read_depths(const solver::Scene& scene);
};

/// Writes the stresses of the lower body, of the upper one if the lower is rigid: stress components (Pa, x3
/// points into the body) and von Mises' stress in all cells. Returns the largest stresses with their places.
Json write_stresses(const StressFiles& files, const solver::Scene& scene, const solver::Solution& solution);

/// The largest von Mises stress for a person.
std::string stresses_text(const Json& found);

}  // namespace slipstick::convergence
