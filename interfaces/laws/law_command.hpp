#pragma once

#include "convergence/commands.hpp"

namespace slipstick::laws {

/// Adds `law`: the contact law of a scene or a profile, for other programs.
convergence::RunCommand add_law_command(CLI::App& app);

}  // namespace slipstick::laws
