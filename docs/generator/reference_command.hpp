#pragma once

#include "convergence/commands.hpp"

namespace slipstick::docs {

/// Adds `reference`, which --help hides: it writes the pages of docs/reference, the manual page and the
/// completion that are made from the program itself.
convergence::RunCommand add_reference_command(CLI::App& app);

}  // namespace slipstick::docs
