#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace slipstick::convergence {

/// The exit code of a program that could not be started, as shells have it.
inline constexpr int kNotStarted = 127;

/// Starts a program, looked for on PATH where its name has no slash; it does not outlive this one (see
/// fork_child, which says what it throws). Returns its number; wait_for_child() says how it ended. output,
/// complaints: the files that get what it writes on standard output and on standard error; empty: those of
/// this program.
pid_t start_program(const std::vector<std::string>& words, const std::filesystem::path& output = {},
                    const std::filesystem::path& complaints = {});

/// Starts a program and waits. Returns its exit code; -1: it could not be started, or was killed.
int run_program(const std::vector<std::string>& words, const std::filesystem::path& output = {},
                const std::filesystem::path& complaints = {});

}  // namespace slipstick::convergence
