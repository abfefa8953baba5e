#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace slipstick {

struct ProgramRun {
  int exit_code;
  std::string output;  ///< standard output and error together
};

/// Runs the program as users do.
inline ProgramRun run_program_with(const std::string& arguments) {
  FILE* const pipe = popen((std::string(SLIPSTICK_PROGRAM) + " " + arguments + " 2>&1").c_str(), "r");
  ProgramRun result{-1, ""};
  std::array<char, 4096> buffer{};
  while (const std::size_t size = fread(buffer.data(), 1, buffer.size(), pipe))
    result.output.append(buffer.data(), size);
  const int status = pclose(pipe);
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}

}  // namespace slipstick
