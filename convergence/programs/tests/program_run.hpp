#pragma once

#include <string>

#include "convergence/programs/run_program.hpp"

namespace slipstick {

struct ProgramRun {
  int exit_code;
  std::string output;  ///< standard output and error together
};

/// Runs a command line as users do, in a shell.
inline ProgramRun run_command(const std::string& line) {
  const auto end =
      convergence::run_program({"sh", "-c", line}, {.captured = convergence::Captured::everything});
  return {end.code, end.output};
}

/// Runs the program with arguments as a shell takes them.
inline ProgramRun run_program_with(const std::string& arguments) {
  return run_command(std::string(SLIPSTICK_PROGRAM) + " " + arguments);
}

}  // namespace slipstick
