#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "convergence/oracle/oracle.hpp"
#include "convergence/results/result_parts.hpp"
#include "solver/scene/scene.hpp"
#include "solver/solution.hpp"

/// Scenes that another program solves.
namespace slipstick::convergence {

/// Which programs may be started. A scene, study or gate file that a stranger wrote must not run a stranger's
/// command: what a file names runs only where the user allows all.
struct AllowedPrograms {
  bool all = false;                         ///< --allow-programs
  std::vector<std::string> overrides = {};  ///< of the command line, which may name one: "solver.program=..."
  std::filesystem::path tied_by = {};       ///< see ProgramOptions
  std::optional<std::string> version = {};  ///< of the program, where it is known; else it is asked
};

/// The override by which a scene is solved by this program, whatever its file names.
inline constexpr const char* kNoProgram = "solver.program=\"\"";

/// The override by which a command line names a program: its file, relative to here.
std::string program_override(const std::filesystem::path& file);

/// Throws InputError where the scene names a program that is not allowed. overrides: those that the scene was
/// read with, last ones first in force.
void require_allowed(const solver::Scene& scene, const std::vector<std::string>& overrides,
                     const AllowedPrograms& allowed);

/// What a scene's program found.
struct ProgramAnswer {
  solver::Scene scene;        ///< under the loads that the program was given, in N and N m
  OracleAnswer exact;         ///< at the same part of its limit moment, where a load is a ratio
  solver::Solution solution;  ///< worked out from its fields alone
  Json program;               ///< name, version, its own numbers, seconds
};

/// Gives the scene to its program and works out the answer from the field that it writes. A load that is a
/// ratio is given as that of the limit moment of the grid's own pressure, as for this program's own methods.
/// Throws ProgramFailure where the program fails; InputError for a scene that it does not solve, and a
/// history.
ProgramAnswer solve_by_program(const solver::Scene& scene, const AllowedPrograms& allowed);

}  // namespace slipstick::convergence
