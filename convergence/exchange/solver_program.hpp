#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "convergence/system/run_program.hpp"
#include "solver/input/setting_key.hpp"
#include "solver/scene/scene.hpp"

/// Other programs that solve scenes; a file describes how each is started.
namespace slipstick::convergence {

/// A program as its file (TOML) describes it.
struct SolverProgram {
  std::filesystem::path file;
  std::string name;
  /// The words that start it, in the folder of its file; {scene}, {field} and {numbers} become files,
  /// {python} the Python that draws reports.
  std::vector<std::string> command;
  std::vector<std::string> version;           ///< words that print its version; empty: none
  std::vector<std::filesystem::path> inputs;  ///< files that its answers depend on
  double time_limit = 600.0;                  ///< s, for one scene
  bool numpy = false;                         ///< it takes the gap as .npy, not as .csv
};

/// Every key of such a file.
const solver::SettingKeys& program_keys();

/// Throws InputError, naming file, key, value and the allowed values.
SolverProgram read_solver_program(const std::filesystem::path& file);

/// A program that was killed, took too long, failed, or wrote no answer that can be read.
class ProgramFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The first line that its version command prints. Throws ProgramFailure.
std::string version_of(const SolverProgram& program, const std::filesystem::path& tied_by);

/// The files on which its answers depend: its own, and the files that its words and `inputs` name.
std::vector<std::filesystem::path> program_files(const SolverProgram& program);

/// The files of one exchange.
struct ExchangeFiles {
  std::filesystem::path scene, field, numbers;
};

/// Runs the program: its last lines of output and its CPU seconds. Throws ProgramFailure; InputError where it
/// ends with code 3: it does not solve such scenes.
ProgramEnd run_solver_program(const SolverProgram& program, const ExchangeFiles& files,
                              const std::filesystem::path& tied_by);

/// The programs that may be started. A scene, study or gate file that a stranger wrote must not run a
/// stranger's command: a program that only a file names runs only if the user allows all.
struct AllowedPrograms {
  bool all = false;                         ///< --allow-programs
  std::vector<std::string> overrides = {};  ///< of the command line, which may name one: "solver.program=..."
  std::filesystem::path tied_by = {};       ///< see ProgramOptions
  std::optional<std::string> version = {};  ///< of the program, where it is known; none: the program prints it
};

/// The override by which a scene is solved by this program, whatever its file names.
inline constexpr const char* kNoProgram = "solver.program=\"\"";

/// The override by which a command line names a program: its file, relative to here.
std::string program_override(const std::filesystem::path& file);

/// Throws InputError where the scene names a program that is neither allowed nor the one that the command
/// line names, whichever way a file may name it.
void require_allowed(const solver::Scene& scene, const AllowedPrograms& allowed);

}  // namespace slipstick::convergence
