#pragma once

#include <functional>
#include <memory>

#include "solver/cache/solve_cache.hpp"
#include "solver/grid/ranks.hpp"
#include "solver/scene/scene.hpp"
#include "solver/solution.hpp"

namespace slipstick::solver {

struct HistoryState;

/// Callbacks of a solve, and objects that it shares with others.
struct SolveOptions {
  /// Called now and then, for the pressure and then for the tractions, with the iterations or applications so
  /// far and what the stopping test sees. What it throws ends the solve.
  std::function<void(int iteration, double change)> progress;
  /// Called at the end of each step of a history.
  std::function<void(const Solution&)> on_step = {};
  /// Objects that solves of one size share; empty: each step shares with the next. They change no digit, and
  /// seconds are those of the solve by itself.
  std::shared_ptr<SolveCache> cache = {};
  /// Called at the end of each step that another follows, with what that one needs.
  std::function<void(const HistoryState&)> on_state = {};
  /// The history goes on from here: such a state of the same scene. The answer has the digits that it would
  /// have had without the break. Empty: from the first step.
  std::shared_ptr<const HistoryState> resumed = {};
  Detail detail = Detail::all;
  /// The processes that share the solve; all of them call solve() alike.
  Ranks ranks = {};
};

/// Solves a scene, step by step; returns the last one, or the first that did not converge. Throws InputError
/// for what the scene got wrong, gross slip and a model that is not on a grid (ModelChoice::exact) among it;
/// what the numbers do is in the status.
Solution solve(const Scene& scene, const SolveOptions& options = {});

}  // namespace slipstick::solver
