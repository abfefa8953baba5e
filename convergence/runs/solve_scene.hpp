#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "convergence/exchange/solver_program.hpp"
#include "convergence/oracle/oracle.hpp"
#include "convergence/results/solve_record.hpp"
#include "convergence/runs/run_spec.hpp"
#include "solver/solve.hpp"

namespace slipstick::convergence {

/// The last step of a scene that was solved on its grid, by this program or another, the exact answer to it,
/// and the record that compares the two, of a history with all its steps.
struct SolvedScene {
  solver::Solution solution;
  OracleAnswer exact;
  SolveRecord record;
};

/// The finished steps of a history, and the state at the end of the last one.
struct FinishedSteps {
  std::shared_ptr<const solver::HistoryState> state;
  std::vector<StepRecord> steps;
};

struct SolveSceneOptions {
  /// See solver::SolveOptions.
  solver::Progress progress = {};
  /// Called at the end of each step of a history, or of the one load.
  std::function<void(const solver::Solution&, const OracleAnswer&)> on_step = {};
  /// How the solve rounds. The exact answer is always rounded to nearest.
  Rounding rounding = Rounding::nearest;
  /// Gets the result of a history that an InputError ends after its first step; it is thrown all the same.
  SolveRecord* incomplete = nullptr;
  /// See solver::SolveOptions.
  std::shared_ptr<solver::SolveCache> cache = {};
  /// Called at the end of each step that another follows, with the steps so far.
  std::function<void(const solver::HistoryState&, const std::vector<StepRecord>& steps)> on_state = {};
  /// See solver::SolveOptions; null: from the first step.
  std::shared_ptr<const FinishedSteps> resumed = {};
  /// See solver::SolveOptions.
  solver::Detail detail = solver::Detail::all;
  /// See solver::SolveOptions.
  solver::Ranks ranks = {};
  /// A scene that names a program is refused by solver::solve(), unless all are allowed here.
  AllowedPrograms programs = {};
};

/// The one way in which a scene is solved on its grid and compared with its exact answer, by whichever
/// command. Throws InputError as solver::solve() does; ProgramFailure where the scene's program fails.
SolvedScene solve_scene(const solver::Scene& scene, const SolveSceneOptions& options = {});

}  // namespace slipstick::convergence
