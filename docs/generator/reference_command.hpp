#pragma once

#include "convergence/commands.hpp"

namespace slipstick::docs {

/// Adds `reference`, which --help hides: commands, options and keys of files as data.
/// docs/generator/reference.py writes pages of docs/reference, the manual page and the completion from it.
convergence::RunCommand add_reference_command(CLI::App& app);

}  // namespace slipstick::docs
