#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "convergence/runs/solve_scene.hpp"
#include "convergence/solve/accuracy.hpp"
#include "convergence/solve/plan.hpp"
#include "convergence/solve/shifted_grids.hpp"

/// Solves to a relative error:
/// 1. On few cells finds the number of parts of the steps whose error is within its part of the target.
/// 2. Chooses mesh and tolerance from measured data; for the twist of a smooth contact the answer is the mean over
///    shifted grids.
/// 3. Solves, and determines the error: against the exact answer, from two meshes, or from the scatter of the
///    shifted grids.
/// 4. While the error is above the target: more parts of the steps, or a finer mesh, up to kMaxRefinements times.
namespace slipstick::convergence {

/// One solve, or one mean over shifted grids.
struct AttemptAccount {
  std::array<solver::Index, 2> cells;
  double tolerance;
  double error;     ///< relative; NaN: not known
  std::string why;  ///< basis of the error, or why it is not known
  double seconds;
  std::vector<ShiftedGrid> grids;  ///< empty: one grid
};

/// The account of an answer on grids.
struct GridAccuracy {
  std::vector<AttemptAccount> attempts;
  double path = 0.0;                              ///< relative error by the length of the steps; NaN: not known
  int substeps = 1;                               ///< parts of each step
  std::optional<double> uncertainty;              ///< of a mean over shifted grids, relative
  std::array<solver::Index, 2> replaced_cells{};  ///< the scene's cells and tolerance, which were replaced
  double replaced_tolerance = 0.0;
  std::optional<std::string> not_reached;  ///< why the target was not reached; none: it was
  std::string note;                        ///< see SolvePlan
};

/// The account of an answer to a target; grid: none for an exact answer.
struct Accuracy {
  double target;         ///< relative error
  std::string quantity;  ///< twist | moment | traction | stick_radius
  ReachedError reached;  ///< by mesh and tolerance
  std::optional<GridAccuracy> grid;

  double path() const { return grid ? grid->path : 0.0; }
  /// Relative error by mesh, tolerance and steps; NaN: not known.
  double error() const { return reached.error + path(); }
};

Json to_json(const Accuracy& accuracy);
/// The same for a person.
std::string accuracy_text(const Accuracy& accuracy);

struct AccurateAnswer {
  SolvedScene answer;  ///< of the last attempt
  Accuracy accuracy;
  bool reached() const { return !accuracy.grid->not_reached; }
};

/// Refinements after the first attempt.
inline constexpr int kMaxRefinements = 3;

/// See above. The scene's cells and tolerance are replaced. Throws InputError as choose_grid() and solve().
AccurateAnswer solve_to_accuracy(const solver::Scene& scene, AccuracyTarget target, const GridSolve& solve);

/// The plan of the first attempt. Throws InputError as require_reachable() and choose_grid().
SolvePlan accuracy_plan(const solver::Scene& scene, AccuracyTarget target);

/// The account of an exact answer: its own uncertainty. Throws InputError if that is above the target.
Accuracy exact_accuracy(const solver::Scene& scene, const AccuracyTarget& target);

}  // namespace slipstick::convergence
