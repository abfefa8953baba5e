#pragma once

#include <cstddef>
#include <iosfwd>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "convergence/results/solve_record.hpp"
#include "convergence/solve/accuracy.hpp"
#include "convergence/solve/scene_file.hpp"
#include "convergence/solve/uncertainty.hpp"
#include "solver/grid/ranks.hpp"
#include "solver/scene/scene.hpp"

/// The ways to solve a scene, one struct each. run() writes the text for a person, fills the result and
/// returns the exit code: 0 converged, 1 not. It throws InputError. After an error the result has what was
/// computed.
namespace slipstick::convergence {

/// Files for the cells of an answer; empty: none.
struct AnswerFiles {
  std::string fields;  ///< of the last step, or of each step where the name holds "{step}"
  std::string figure;
};

/// Whether a name holds "{step}", and the name with the step's number there.
bool has_step(const std::string& file);
std::string file_of_step(std::string file, std::size_t step);

/// The HDF5 file that keeps the state of a history between its steps.
struct CheckpointFile {
  std::string file;
  bool resume = false;  ///< continue from the file if it exists
};

/// Solves the runs that come on standard input: the worker of a ProcessPool.
struct ServeRuns {
  std::string folder;                         ///< for the results
  std::optional<std::uint64_t> memory_limit;  ///< bytes of one run
  int run(std::ostream& text, Json& result) const;
};

/// Predicts memory and time of a solve; of one rank if several share it.
struct PlanSolve {
  solver::Scene scene;
  int ranks = 1;
  int run(std::ostream& text, Json& result) const;
};

/// Predicts memory and time of the first attempt to reach an accuracy.
struct PlanAccuracy {
  solver::Scene scene;
  AccuracyTarget target;
  int run(std::ostream& text, Json& result) const;
};

/// Gives the exact answer.
struct AnswerExactly {
  solver::Scene scene;
  AnswerFiles files;
  solver::Ranks ranks = {};
  SolveRecord answer(std::ostream& text, Json& result) const;
  int run(std::ostream& text, Json& result) const;
};

/// Gives the exact answer if its own uncertainty is within the target.
struct AnswerExactlyTo {
  AnswerExactly exact;
  AccuracyTarget target;
  int run(std::ostream& text, Json& result) const;
};

/// Solves on the scene's mesh to the scene's tolerance.
struct SolveOnGrid {
  SceneFile source;
  solver::Scene scene;
  AnswerFiles files;
  std::optional<CheckpointFile> checkpoint;
  solver::Ranks ranks = {};
  SolveRecord answer(std::ostream& text, Json& result) const;
  int run(std::ostream& text, Json& result) const;
};

/// Solves on meshes and to tolerances that reach an accuracy.
struct SolveToAccuracy {
  solver::Scene scene;
  AccuracyTarget target;
  AnswerFiles files;
  int run(std::ostream& text, Json& result) const;
};

/// Solves, then computes how uncertain the inputs make the converged answer.
struct SolveWithUncertainty {
  std::variant<AnswerExactly, SolveOnGrid> solve;
  SceneFile source;
  std::vector<UncertainInput> inputs;
  int run(std::ostream& text, Json& result) const;
};

using SolveRequest = std::variant<ServeRuns, PlanSolve, PlanAccuracy, AnswerExactly, AnswerExactlyTo,
                                  SolveOnGrid, SolveToAccuracy, SolveWithUncertainty>;

}  // namespace slipstick::convergence
