#pragma once

#include <functional>
#include <memory>

#include "solver/cache/solve_cache.hpp"
#include "solver/grid/ranks.hpp"
#include "solver/newton/safeguards.hpp"
#include "solver/scene/scene.hpp"
#include "solver/solution.hpp"

namespace slipstick::solver {

struct HistoryState;

/// Observes a solve. An exception that one of these functions throws ends it.
struct Observer {
  Progress progress = {};  ///< of the pressure, then of the tractions
  /// Called with the solution at the end of each step; the last one is returned as it leaves it.
  std::function<void(Solution&)> step = {};
  /// Called with the state at the end of each step that another follows.
  std::function<void(const HistoryState&)> state = {};
};

/// How a scene is solved.
struct SolveOptions {
  Observer observer = {};
  /// Objects that solves of one size share; empty: each step shares with the next. They change no digit, and
  /// seconds are those of the solve by itself.
  std::shared_ptr<SolveCache> cache = {};
  /// A state that the observer received, of the same scene: the history continues after its step, with the
  /// digits of a solve without interruption. Empty: the history begins with its first step.
  std::shared_ptr<const HistoryState> resumed = {};
  Detail detail = Detail::all;
  /// The processes that share the solve; all of them call solve() with the same scene.
  Ranks ranks = {};
};

/// Solves a scene, step by step; returns the last one, or the first that did not converge. Its
/// resolution.path is zero: that takes further solves. Throws
/// InputError for mistakes in the scene, gross slip and a model that is not on a grid (ModelChoice::exact)
/// included; numerical failure is a status.
///
/// 1. Makes the scene dimensionless, on its grid (model/make_model.hpp).
/// 2. For each step of the history, in parts (history/history_step.hpp): pressure, tractions, numbers
///    (step/solve_step.hpp).
/// 3. Puts units on the answer (step/solve_step.hpp).
Solution solve(const Scene& scene, const SolveOptions& options = {});

}  // namespace slipstick::solver
