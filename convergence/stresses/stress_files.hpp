#pragma once

#include <string>
#include <vector>

#include "convergence/results/result_parts.hpp"
#include "solver/scene/scene.hpp"
#include "solver/solution.hpp"
#include "solver/stresses/fatigue.hpp"

namespace slipstick::convergence {

/// Files that get the stresses below the surface: one volume, or one for each depth.
struct StressFiles {
  /// The name holds "{depth}" where there are several and no volume, "{body}" for both bodies; empty: none.
  std::string file;
  std::vector<std::string> depth_words;  ///< as --depths takes them: depth_of() in the source
  std::vector<double> depths = {};       ///< m, by read_depths()
  solver::FatigueCoefficients fatigue = {};
  std::string figure = {};  ///< of a volume, "{body}" as in file; empty: none

  std::string figure_name(solver::Body body) const;
  bool is_volume() const;                                        ///< by the ending .vtr
  std::string name(std::size_t depth, solver::Body body) const;  ///< of the file of depths[depth]
  /// The lower one, the upper one if the lower is rigid, or both where the name holds "{body}".
  std::vector<solver::Body> bodies(const solver::Scene& scene) const;
  /// Throws InputError for a depth that is not above zero, and for a scene whose stresses are not known.
  void read_depths(const solver::Scene& scene);
};

/// Writes the stresses of each of bodies(): stress components (Pa, x3 points into the body) and von Mises'
/// stress in all cells. Returns the largest stresses with their places, of the second body as "upper". With
/// coefficients of fatigue also the largest parameters over the states of a cycle.
Json write_stresses(const StressFiles& files, const solver::Scene& scene, const solver::Solution& solution,
                    const std::vector<solver::SolutionFields>& cycle);

/// The largest von Mises stress and the parameters of fatigue for a person.
std::string stresses_text(const Json& found);

}  // namespace slipstick::convergence
