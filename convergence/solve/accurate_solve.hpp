#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "convergence/runs/solve_scene.hpp"
#include "convergence/solve/accuracy.hpp"

/// Solves until a wanted accuracy is reached.
namespace slipstick::convergence {

using GridSolve = std::function<SolvedScene(const solver::Scene&)>;

/// The last attempt, and the account of all.
struct AccurateAnswer {
  SolvedScene answer;
  Json accuracy;  ///< {wanted, quantity, reached, how, why, model, attempts, predicted_seconds, replaced,
                  ///< note}
  bool reached = false;
};

/// Refinements after the first attempt.
inline constexpr int kMaxRefinements = 3;

/// Chooses, solves, determines the error, refines. The scene's cells and tolerance are replaced. Throws
/// InputError as choose_grid() and solve().
AccurateAnswer solve_to_accuracy(const solver::Scene& scene, const AccuracyTarget& target,
                                 const GridSolve& solve);

/// The scene as it would be solved first.
solver::Scene scene_for(const solver::Scene& scene, const AccuracyTarget& target);

/// The account of an exact answer: its own uncertainty, and what a grid would have cost. Throws InputError
/// where that uncertainty is above the target.
Json exact_accuracy(const solver::Scene& scene, const AccuracyTarget& target);

/// A few lines for a person, from a result's `accuracy`.
std::string accuracy_text(const Json& result);

}  // namespace slipstick::convergence
