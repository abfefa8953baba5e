#pragma once

#include <array>
#include <cfenv>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "convergence/results/solve_record.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// Equivalent scenes of the same contact: mirrored (x2 to -x2); turned by a quarter (x1 to x2); shifted to
/// other cells of a larger grid; in other units (lengths in mm); with the bodies exchanged; on two threads.
enum class Variant { none, mirrored, turned, shifted, in_other_units, exchanged, two_threads };

inline constexpr std::array kVariants{Variant::mirrored,       Variant::turned,    Variant::shifted,
                                      Variant::in_other_units, Variant::exchanged, Variant::two_threads};

std::string to_string(Variant variant);

/// Throws std::invalid_argument for a word that to_string() does not give.
Variant variant_of(const std::string& word);

/// Why a scene has no such equivalent; empty: it has. Files and random surfaces cannot be turned, and a
/// moment about the grid's origin is another one where a force acts off the origin.
std::string why_not(const solver::Scene& scene, Variant variant);

/// The equivalent scene. Shifted: by two cells along x1 and minus one along x2, on a grid four cells wider on
/// each side; it needs scene.grid.extent. Twists of mirrored and exchanged scenes have the opposite sign.
solver::Scene transformed(solver::Scene scene, Variant variant);

/// Rounding of floating-point results. With upward or downward rounding all errors have the same sign, so
/// that the difference from the usual solve shows the largest effect of rounding.
enum class Rounding : int { nearest = FE_TONEAREST, upward = FE_UPWARD, downward = FE_DOWNWARD };

/// One solve for a study, a gate or the page: a scene with some keys changed.
struct RunSpec {
  std::filesystem::path scene;
  std::vector<std::string> overrides = {};  ///< "key=value", as --set takes them
  Rounding rounding = Rounding::nearest;
  Variant variant = Variant::none;
  std::filesystem::path fields = {};  ///< gets the fields of the last step; empty: none
  /// step_before_file() gets the fields of the step before, since the slip of the last step starts there.
  bool step_before = false;
  bool profile = false;       ///< the result has the tractions along two radii
  bool stress_error = false;  ///< the result has the error of its stresses, see stress_error()
  /// The version that the scene's program states; the pool runs the program for it, where that is allowed.
  std::string program_version = {};
};

/// The same run with further overrides, which have priority.
RunSpec changed(RunSpec run, const std::vector<std::string>& overrides);

/// Another method for each scene: its name, and the override of the scene's keys that chooses it.
struct BesideMethod {
  std::string name;
  std::string override;
  bool is_program = false;
};
/// A word of solver.method, or the file of a program (TOML). Throws InputError for anything else.
BesideMethod read_beside_method(const std::string& word);

/// The complaint of a message about an override that the file of a study or gate gives; empty if the message
/// is about the command line.
std::string complaint_of_file(const std::string& message, const std::vector<std::string>& command_line);

/// A run whose scene has been read.
struct PreparedRun {
  RunSpec spec;
  solver::Scene scene;
  /// Everything that the answer depends on, except this program: text of the scene and of the files that it
  /// reads, overrides, rounding, and further output.
  std::string cache_key;
  std::string name;  ///< that no other cache key has, fit for a file
};

/// Throws InputError for a scene that cannot be read.
PreparedRun prepare_run(const RunSpec& spec);

/// The files that a scene's answer depends on: the scene, heights, pressures, its program.
/// Throws InputError for a program's file that cannot be read.
std::vector<std::filesystem::path> input_files(const solver::Scene& scene);

/// A whole file.
std::string read_text(const std::filesystem::path& file);

/// The override that gives a grid `across` cells along its longer side, in the shape of the scene's own.
std::string cells_override(const solver::Scene& scene, solver::Index across);

/// Whether the files that a scene reads, height maps or a pressure, have its grid: no other can be chosen.
bool has_given_grid(const solver::Scene& scene);

/// The file for the fields of the step before the last: NAME-before.csv for NAME.csv.
std::filesystem::path step_before_file(const std::filesystem::path& fields);

/// A run for a person: "paper, grid.cells=[96,96], rounded downward".
std::string run_text(const RunSpec& spec);

/// The record of a run without an answer; status: refused or failed.
SolveRecord not_computed(RunStatus status, const std::string& message, const RunSpec& spec);

/// Counts the runs without an answer, and keeps the message of the first.
class FailedRuns {
 public:
  /// name: of the run; equal names count once.
  void add(const std::string& name, const Json& result);

  /// {count, of, first: {run, message}}; first is missing where none failed.
  Json json() const;

  /// "1 of 35 runs failed; the first (paper, grid.cells=[96,96]): its process was killed by signal 9"; empty
  /// where none failed.
  std::string text() const;

  std::size_t count() const;

 private:
  std::map<std::string, bool> runs_;                          ///< whether it failed, once or more
  std::optional<std::pair<std::string, std::string>> first_;  ///< the first that failed, and its message
};

/// The same of a result's key failed_runs.
std::string failed_runs_text(const Json& result);

}  // namespace slipstick::convergence
