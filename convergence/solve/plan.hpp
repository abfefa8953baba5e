#pragma once

#include <array>
#include <optional>
#include <string>

#include "convergence/results/result_parts.hpp"
#include "convergence/solve/accuracy.hpp"
#include "convergence/stresses/stress_files.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// Cells along the longer side of the grid on which an application is timed.
inline constexpr solver::Index kReferenceCells = 64;

/// Seconds of one application of the scene's tangential operator on this machine, with symmetry used: the
/// unit of work in which solves on different machines can be compared. The grid has the scene's ratio of
/// sides and kReferenceCells cells along the longer side; a height map keeps its own grid.
double application_seconds(solver::Scene scene);

/// Predicted cost of the stresses below the surface after a solve.
struct StressPlan {
  double planes;   ///< whose stresses are computed: depths of bodies and of states
  double bytes;    ///< of the program meanwhile, at most
  double seconds;  ///< of CPU time on this machine, with the files
};
StressPlan plan_stresses(const StressFiles& files, const solver::Scene& scene);
/// Throws OutOfMemory where they do not fit; InputError as solver::make_model().
void require_memory(const StressFiles& files, const solver::Scene& scene);

/// Predicted size and cost of a solve.
struct SolvePlan {
  std::optional<std::array<solver::Index, 2>> cells;  ///< none: the exact solution needs no grid
  double tolerance = 0.0;
  double unknowns = 0.0;     ///< after symmetry
  double bytes = 0.0;        ///< of one rank, at most
  double least_bytes = 0.0;  ///< of one rank, before any cell is known to be in contact
  int ranks = 1;
  double sent_bytes = 0.0;  ///< by one rank for each application of the operator
  double seconds = 0.0;     ///< on one rank of this machine, of all grids; NaN: not measured for this method
  int grids = 1;            ///< solves whose mean is the answer
  std::string note = {};    ///< names surfaces outside the data that chose the mesh; empty: none
  std::optional<StressPlan> stresses = {};  ///< computed after the solve, in memory that it has left
};

/// Throws InputError as make_model(), and as require_oracle() for the exact model.
SolvePlan plan_solve(const solver::Scene& scene, int ranks = 1);

Json to_json(const SolvePlan& plan);
/// The same for a person.
std::string plan_text(const SolvePlan& plan);

}  // namespace slipstick::convergence
