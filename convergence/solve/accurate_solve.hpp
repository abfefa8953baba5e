#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "convergence/runs/solve_scene.hpp"
#include "convergence/solve/accuracy.hpp"
#include "convergence/solve/shifted_grids.hpp"

/// Solves until a wanted accuracy is reached.
namespace slipstick::convergence {

/// The last attempt, and the account of all.
struct AccurateAnswer {
  SolvedScene answer;
  Json accuracy;  ///< {wanted, quantity, reached, how, why, uncertainty, attempts, replaced, note}
  bool reached = false;
};

/// Refinements after the first attempt.
inline constexpr int kMaxRefinements = 3;

/// Chooses, solves, determines the error, refines. For the twist of a smooth contact each attempt is the mean
/// over shifted grids: it is reached once its uncertainty and, where it is known, its error are small
/// enough. The scene's cells and tolerance are replaced. Throws InputError as choose_grid() and solve().
AccurateAnswer solve_to_accuracy(const solver::Scene& scene, AccuracyTarget target, const GridSolve& solve);

/// The plan of the first attempt, as plan_json(). For a mean over shifted grids it has their number, `grids`,
/// and the time of all.
Json accuracy_plan(const solver::Scene& scene, AccuracyTarget target);

/// Surfaces that the measured data, by which the first mesh is chosen, do not cover; empty: none.
std::string note_on(const solver::Scene& scene);

/// The account of an exact answer: its own uncertainty. Throws InputError where that is above the target.
Json exact_accuracy(const solver::Scene& scene, const AccuracyTarget& target);

/// A few lines for a person, from a result's `accuracy`.
std::string accuracy_text(const Json& result);

}  // namespace slipstick::convergence
