#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// The programs that may be started. A scene, study or gate file that a stranger wrote must not run a
/// stranger's command: a program that only a file names runs only if the user allows all.
struct AllowedPrograms {
  bool all = false;                         ///< --allow-programs
  std::vector<std::string> overrides = {};  ///< of the command line, which may name one: "solver.program=..."
  std::filesystem::path tied_by = {};       ///< see ProgramOptions
  std::optional<std::string> version =
      {};  ///< of the program, where it is known; none: the program prints it
};

/// The override by which a scene is solved by this program, whatever its file names.
inline constexpr const char* kNoProgram = "solver.program=\"\"";

/// The override by which a command line names a program: its file, relative to here.
std::string program_override(const std::filesystem::path& file);

/// Throws InputError where the scene names a program that is neither allowed nor the one that the command
/// line names, whichever way a file may name it.
void require_allowed(const solver::Scene& scene, const AllowedPrograms& allowed);

}  // namespace slipstick::convergence
