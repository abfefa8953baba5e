#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace slipstick::convergence {

/// Runs a program, looked for on PATH where its name has no slash, and waits. Returns its exit code; -1: it
/// could not be started, or was killed. output, complaints: the files that get what it writes on standard
/// output and on standard error; empty: those of this program.
int run_program(const std::vector<std::string>& words, const std::filesystem::path& output = {},
                const std::filesystem::path& complaints = {});

}  // namespace slipstick::convergence
