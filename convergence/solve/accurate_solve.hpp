#pragma once

#include <functional>
#include <string>

#include "convergence/solve/accuracy.hpp"
#include "solver/solve.hpp"

/// Solves until a wanted accuracy is reached.
namespace slipstick::convergence {

/// What a solve on a grid gives.
struct GridAnswer {
  solver::Solution solution;
  OracleAnswer exact;
  Json result;
};
using GridSolve = std::function<GridAnswer(const solver::Scene&)>;

/// The last attempt, and the account of all.
struct AccurateAnswer {
  GridAnswer answer;
  Json accuracy;  ///< {wanted, quantity, reached, how, why, model, attempts, predicted_seconds, replaced,
                  ///< note}
  bool reached = false;
};

/// Refinements after the first attempt.
inline constexpr int kMostRefinements = 3;

/// Chooses, solves, tells the error, refines. The scene's cells and tolerance are replaced. Throws InputError
/// as choose_grid() and solve().
AccurateAnswer solve_to_accuracy(const solver::Scene& scene, const AccuracyWish& wish,
                                 const GridSolve& solve);

/// The scene as it would be solved first.
solver::Scene scene_for(const solver::Scene& scene, const AccuracyWish& wish);

/// The account of an exact answer: its own uncertainty, and what a grid would have cost. Throws InputError
/// where that uncertainty is above the wish.
Json exact_accuracy(const solver::Scene& scene, const AccuracyWish& wish);

/// A few lines for a person, from a result's `accuracy`.
std::string accuracy_text(const Json& result);

}  // namespace slipstick::convergence
