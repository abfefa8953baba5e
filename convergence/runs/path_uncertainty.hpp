#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "solver/solve.hpp"

/// The error that the number of parts of its steps (solver/history/history_step.hpp) leaves in a history:
/// 1. the scene is posed on few cells, on which parts leave nearly the same errors as on many;
/// 2. its history is solved there in the scene's parts and in four times as many;
/// 3. the difference at the end of each step, times a safety factor, is the uncertainty of that step.
namespace slipstick::convergence {

/// Whether the number of parts can change the answer. It cannot where a surface of revolution between similar
/// bodies is only twisted, under one normal load: slip stays along circles. coupled: see solver::Solution.
bool depends_on_path(const solver::Scene& scene, bool coupled);

class PathUncertainty {
 public:
  /// Solves the two histories, unless the number of parts cannot matter. solution: of one of the scene's steps.
  PathUncertainty(const solver::Scene& scene, const solver::Solution& solution);

  /// At the end of a step, counted from 0 over all cycles. Infinite where a coarse history broke off, or a
  /// file of pressures fixes the grid.
  solver::Quantities at(std::size_t step) const;

 private:
  bool matters_ = false;
  std::vector<solver::Quantities> at_ends_;  ///< of the first steps; of later ones it grows in proportion
  bool broke_off_ = false;
};

/// From so many parts on the error of n parts falls like 1/n well enough to be extrapolated.
inline constexpr int kFewestCorrected = 4;

/// Relative change of the twist, or of the moment of an imposed twist, at the end of the last step from the
/// scene's parts to infinitely many, and the uncertainty that it leaves.
struct PathCorrection {
  double change;
  double uncertainty;
};

/// Each finer path on a coarser mesh (a combination technique): from n to 4 n parts on a coarse mesh, from there to 16
/// n on one with half as many cells, and to the limit of an error c/n + d/n^2. None where the parts cannot matter, are
/// fewer than kFewestCorrected, a coarse history broke off, an earlier step has a larger error than the last one (a
/// reversal), or a step changes the normal load and another load. solution: of the scene's last step.
std::optional<PathCorrection> path_correction(const solver::Scene& scene, const solver::Solution& solution);

/// solver::solve() with the path's uncertainty in the resolution of each step, where all details are wanted.
/// The seconds of the estimate count as the setup of the first step.
solver::Solution solve_with_path(const solver::Scene& scene, solver::SolveOptions options = {});

}  // namespace slipstick::convergence
