#pragma once

#include "convergence/commands.hpp"

namespace slipstick::bench {

using convergence::RunCommand;

/// Adds `bench`: times methods and meshes with the error of each and draws the figure, or compares two builds
/// or two methods. The result is timings in Google Benchmark's JSON.
RunCommand add_bench_command(CLI::App& app);

/// Adds `compare`. Exit code 0: nothing is slower, 1: something is, 2: it could not be judged.
RunCommand add_compare_command(CLI::App& app);

}  // namespace slipstick::bench
