#pragma once

#include <cfenv>
#include <filesystem>
#include <string>
#include <vector>

#include "convergence/runs/variant.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// How floating-point results are rounded. A solve that is rounded upwards or downwards throughout differs
/// from the usual one by what rounding does to it, at its worst: all roundings lean to the same side.
enum class Rounding : int { nearest = FE_TONEAREST, upward = FE_UPWARD, downward = FE_DOWNWARD };

/// One solve that a study, a gate or the page asks for: a scene with some keys changed.
struct RunSpec {
  std::filesystem::path scene;
  std::vector<std::string> overrides = {};  ///< "key=value", as --set takes them
  Rounding rounding = Rounding::nearest;
  Variant variant = Variant::none;
  std::filesystem::path fields = {};  ///< gets the fields of the last step; empty: none
  /// Of a history, a file beside gets those of the step before, from which the last one's slip is measured.
  bool step_before = false;
  bool profile = false;  ///< the result has the tractions along two radii
  /// What the scene's program says its version is: the pool asks it, once it knows that it may run.
  std::string program_version = {};
};

/// The same run with further overrides, which are the last to hold.
RunSpec changed(RunSpec run, const std::vector<std::string>& overrides);

/// The complaint of a message about an override that the file of a study or gate gives; empty if the message
/// is about the command line.
std::string complaint_of_file(const std::string& message, const std::vector<std::string>& command_line);

/// A run whose scene has been read.
struct PreparedRun {
  RunSpec spec;
  solver::Scene scene;
  /// All that the answer depends on, the program apart: text of the scene and of the files that it reads,
  /// overrides, rounding, what is asked for beside the result.
  std::string cache_key;
  std::string name;  ///< that no other cache key has, fit for a file
};

/// Throws InputError for a scene that cannot be read.
PreparedRun prepare_run(const RunSpec& spec);

/// The files that a scene's answer depends on: its own, those of heights and pressures, of its program.
/// Throws InputError for a program's file that cannot be read.
std::vector<std::filesystem::path> input_files(const solver::Scene& scene);

/// A whole file.
std::string read_text(const std::filesystem::path& file);

/// The override that gives a grid `across` cells along its longer side, in the shape of the scene's own.
std::string cells_override(const solver::Scene& scene, solver::Index across);

/// Whether the files that a scene reads, height maps or a pressure, have its grid: no other can be chosen.
bool has_given_grid(const solver::Scene& scene);

/// The file that gets the fields of the step before the last: NAME-before.csv beside NAME.csv.
std::filesystem::path step_before_file(const std::filesystem::path& fields);

/// A run for a person: "paper, grid.cells=[96,96], rounded downward".
std::string run_text(const RunSpec& spec);

}  // namespace slipstick::convergence
