#pragma once

#include <cstddef>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "convergence/solve/accuracy.hpp"
#include "convergence/solve/scene_file.hpp"
#include "convergence/stresses/stress_files.hpp"
#include "solver/grid/ranks.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

class TemporaryFolder;

/// Files for the cells and steps of an answer; empty: none.
struct AnswerFiles {
  std::string fields;  ///< of the last step, or of each step where the name holds "{step}"
  std::string figure;  ///< the same; of a history with its loop
  std::string loop;    ///< CSV with a row for each step
  /// Gets the cells of each step that the figures need; null: the figure shows the last step.
  std::shared_ptr<const TemporaryFolder> cells_of_steps;
};

/// Whether a name holds "{step}", and the name with the step's number there.
bool has_step(const std::string& file);
std::string file_of_step(std::string file, std::size_t step);

/// The HDF5 file that keeps the state of a history between its steps.
struct CheckpointFile {
  std::string file;     ///< empty: none
  bool resume = false;  ///< continue from the file if it exists
};

/// A scene, and how to solve it: exactly where its model is the exact one, else on a grid.
struct SolveRequest {
  SceneFile source;
  solver::Scene scene;                        ///< read from the source
  std::optional<AccuracyTarget> target = {};  ///< cells and tolerance are chosen for it; none: the scene has them
  bool plan = false;                          ///< only predicts memory and time, of one of planned_ranks
  int planned_ranks = 1;
  bool continuum = false;                      ///< the certificate gets the gap of the continuous problem
  std::optional<double> proven = {};           ///< cells are chosen for an interval of this relative width
  std::vector<UncertainInput> uncertain = {};  ///< they give the answer its uncertainty
  AnswerFiles files = {};
  StressFiles stresses = {};
  CheckpointFile checkpoint = {};
  solver::Ranks ranks = {};  ///< they share the solve
};

/// Writes the text for a person, fills the result and returns the exit code: 0 converged, 1 not. Throws
/// InputError; after an error the result has what was computed.
int run_request(const SolveRequest& request, std::ostream& text, Json& result);

}  // namespace slipstick::convergence
